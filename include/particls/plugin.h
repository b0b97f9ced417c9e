/// @file plugin.h
/// The door for a user's shared object: contact laws, bond laws, shapes, body forces and observers. It exports one function:
///
///     pls_status particls_plugin(pls_plugin_host *host) { return host->add_law(host, &my_law_ops); }
///     const uint32_t particls_plugin_api = PLS_API_VERSION;
#ifndef PARTICLS_PLUGIN_H
#define PARTICLS_PLUGIN_H

#include <particls/bond.h>
#include <particls/force.h>
#include <particls/law.h>
#include <particls/observe.h>
#include <particls/shape.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pls_plugin_host pls_plugin_host;
struct pls_plugin_host
{
    uint32_t api_version; ///< of the running library
    pls_status (*add_law)(pls_plugin_host *host, const pls_law_ops *ops);
    pls_status (*add_shape)(pls_plugin_host *host, const pls_shape_ops *ops);
    pls_status (*add_force)(pls_plugin_host *host, const pls_force_ops *ops);
    pls_status (*add_observer)(pls_plugin_host *host, const pls_observer_ops *ops);
    pls_status (*add_bond)(pls_plugin_host *host, const pls_bond_ops *ops);
};

typedef pls_status pls_plugin_function(pls_plugin_host *host);
#define PLS_PLUGIN_FUNCTION "particls_plugin"
#define PLS_PLUGIN_API      "particls_plugin_api"

#ifdef __cplusplus
}
#endif
#endif
