#!/usr/bin/env bash
# The generated pages are what the program prints, and the documents' links lead somewhere.
# Runs in an empty folder with PARTICLS (the program) and PARTICLS_SOURCE (the source tree).
set -uo pipefail

failures=0
complain() {
    echo "$*" >&2
    failures=$((failures + 1))
}

same_page() { # <page> <option of schema>
    "$PARTICLS" schema "$2" >page.md || complain "particls schema $2 failed"
    cmp -s page.md "$PARTICLS_SOURCE/docs/$1" || complain "docs/$1 is out of date: particls schema $2 > docs/$1"
}

same_page scene.md --reference
same_page fields.md --fields

# Links to files, without those to the web and to places within a page.
for page in "$PARTICLS_SOURCE"/*.md "$PARTICLS_SOURCE"/docs/*.md "$PARTICLS_SOURCE"/examples/*/README.md "$PARTICLS_SOURCE"/plugins/*/README.md; do
    [ -e "$page" ] || continue
    while read -r link; do
        [ -e "$(dirname "$page")/${link%%#*}" ] || complain "$page links to $link, which is not there"
    done < <(grep -o '](\([^)# ][^)]*\))' "$page" | sed 's/^](//; s/)$//' | grep -v '^[a-z]*:')
done

[ $failures -eq 0 ] || exit 1
