#!/usr/bin/env bash
# An installed library can be used through pkg-config and through CMake, and a plugin can be compiled against it.
# Runs in an empty folder with PARTICLS_BUILD (build tree), CC and PARTICLS_SANITIZE (as configured there, may be empty).
set -euo pipefail

prefix=$PWD/prefix
sanitize=()
if [ -n "${PARTICLS_SANITIZE:-}" ]; then sanitize=("-fsanitize=$PARTICLS_SANITIZE"); fi

# Installed to one place and moved to another: nothing may hold the prefix.
cmake --install "$PARTICLS_BUILD" --prefix "$PWD/first" >install.log
mv first "$prefix"

cat >user.c <<'C'
#include <particls/status.h>
#include <stdio.h>
int main(void) { return puts(pls_status_text(PLS_OUT_OF_MEMORY)) < 0; }
C

says_so() { # <program>: it prints the text
    local text
    text=$("$1")
    if [ "$text" != "out of memory" ]; then echo "$1 printed \"$text\"" >&2; exit 1; fi
}

pkgconfig=$(dirname "$(find "$prefix" -name particls.pc)")
export PKG_CONFIG_PATH=$pkgconfig
read -r -a flags <<<"$(pkg-config --cflags --libs particls)"
"$CC" "${sanitize[@]}" user.c -o user-pkg-config "${flags[@]}" "-Wl,-rpath,$(pkg-config --variable=libdir particls)"
says_so ./user-pkg-config

cat >CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(user C)
find_package(particls 0.1 REQUIRED)
add_executable(user user.c)
target_link_libraries(user PRIVATE particls::particls)
CMAKE
cmake -S . -B user-cmake -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_COMPILER="$CC" -DCMAKE_C_FLAGS="${sanitize[*]}" >cmake.log
cmake --build user-cmake >>cmake.log
says_so user-cmake/user

cat >plugin.c <<'C'
#include <particls/particls.h>
pls_status particls_plugin(pls_plugin_host *host);
pls_status particls_plugin(pls_plugin_host *host) { return host ? PLS_OK : pls_fail(PLS_PLUGIN, "no host"); }
const uint32_t particls_plugin_api = PLS_API_VERSION;
C
read -r -a flags <<<"$(pkg-config --variable=plugin_cflags particls)"
"$CC" -Wall -Wextra -Werror "${flags[@]}" plugin.c -o plugin.so

# The installed program says how to compile a plugin, from any folder, and loads what comes of it.
if [ -x "$PARTICLS" ]; then
    "$prefix/bin/particls" --help >/dev/null
    mkdir elsewhere
    cp "$PARTICLS_SOURCE/plugins/template/my_plugin.c" elsewhere
    (
        PATH=$prefix/bin:$PATH
        cd elsewhere
        "$CC" $(particls plugin --cflags) -Wall -Wextra -Werror my_plugin.c -o my_plugin.so
        case "$(particls plugin --cflags)" in *"-I$prefix/include") ;; *) echo "the flags do not name the installed headers" >&2; exit 1 ;; esac
        particls info my_plugin.so | grep -q '### my_observer'
        cd ..
        particls info elsewhere/my_plugin.so | grep -q '### my_force'
    )
fi
echo "installed, found and linked"
