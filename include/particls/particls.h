/// @file particls.h
/// Everything public, for users. Inside the library each file includes only the topics it needs.
#ifndef PARTICLS_PARTICLS_H
#define PARTICLS_PARTICLS_H

#include <particls/field.h>
#include <particls/force.h>
#include <particls/law.h>
#include <particls/memory.h>
#include <particls/observe.h>
#include <particls/parameter.h>
#include <particls/plugin.h>
#include <particls/run.h>
#include <particls/scene.h>
#include <particls/shape.h>
#include <particls/state.h>
#include <particls/status.h>
#include <particls/threads.h>
#include <particls/types.h>
#include <particls/world.h>

#endif
