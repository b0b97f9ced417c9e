#!/usr/bin/env bash
# The program from outside: verbs, options, exit codes (0 done, 1 failed, 2 wrong usage or scene), messages that help.
# Runs in an empty folder with PARTICLS (the program).
set -uo pipefail

failures=0

expect() { # <exit status> <words of the output> <arguments...>
    local wanted=$1 words=$2 output status
    shift 2
    output=$("$PARTICLS" "$@" 2>&1 </dev/null)
    status=$?
    if [ $status -ne "$wanted" ]; then
        echo "particls $*: exit status $status instead of $wanted" >&2
        printf '%s\n' "$output" >&2
        failures=$((failures + 1))
    elif ! grep -qF -- "$words" <<<"$output"; then
        echo "particls $*: '$words' is not in the output:" >&2
        printf '%s\n' "$output" >&2
        failures=$((failures + 1))
    fi
}

expect_file() { # <path>
    if [ ! -s "$1" ]; then
        echo "$1 is missing or empty" >&2
        failures=$((failures + 1))
    fi
}

cat >small.yaml <<'YAML'
particls: 1
title: two spheres meet
materials:
  grain: {density: 1000}
shapes:
  ball: {sphere: {radius: 0.1}}
bodies:
  - {name: left, shape: ball, material: grain, position: [-0.11, 0, 0], velocity: [1, 0, 0]}
  - {name: right, shape: ball, material: grain, position: [0.11, 0, 0]}
contact:
  - {between: [grain, grain], law: elastic, kn: 10000, ks: 5000, friction: 0.3}
time: {end: 0.1, dt: 1.0e-4}
observe:
  - {particle: left, name: left, quantities: [position, velocity], every: 0.01}
  - {frames: vtk, name: picture, every: 0.05, contacts: true}
YAML
sed 's/dt: 1.0e-4/dt: 1.0/' small.yaml >unstable.yaml
sed 's/density/densty/' small.yaml >misspelt.yaml
: >empty.yaml
sed -e 's/kn: 10000, ks: 5000/kn: 100, ks: 50/' -e 's/velocity: \[1,/velocity: [10,/' small.yaml >clash.yaml

# The program and its verbs.
expect 2 "usage: particls VERB"
expect 0 "usage: particls VERB" --help
expect 0 "usage: particls VERB" help
expect 0 "particls 0." --version
expect 0 "particls 0." version
expect 2 "did you mean 'run'?" rnu
expect 2 "there is no verb 'juggle'" juggle
for verb in run resume check info render schema plugin; do
    expect 0 "usage: particls $verb" "$verb" --help
    expect 0 "example:" help "$verb"
    expect 2 "there is no option '--nonsense'" "$verb" --nonsense
    expect 2 "there is no option '-Z'" "$verb" -Z
done
expect 2 "there is no verb 'nothing'" help nothing

# Options.
expect 2 "did you mean '--overwrite'?" run small.yaml --overwrit3
expect 2 "needs an argument" run small.yaml --output
expect 2 "needs an argument" run small.yaml -o
expect 2 "scene file is missing" run
expect 2 "one scene file is expected" run small.yaml other.yaml
expect 2 "--set takes PATH=VALUE" run small.yaml --set nothing
expect 2 "--threads takes a number" run small.yaml --threads many
expect 2 "--threads takes a number" run small.yaml --threads 0
expect 2 "--until takes a time" run small.yaml --until soon
expect 2 "--until takes a time" run small.yaml --until -1
expect 2 "run directory is missing" resume
expect 2 "file or directory is missing" info
expect 2 "is missing" render
expect 2 "no argument is expected" schema something
expect 2 "--cflags" plugin

# Scenes that cannot be run leave nothing behind.
expect 2 "nothing.yaml" run nothing.yaml
expect 2 "particls" run .
expect 2 "empty.yaml" run empty.yaml
expect 2 "density" run misspelt.yaml
expect 2 "step" run unstable.yaml
expect 2 "did you mean 'end'?" run small.yaml --set time.ende=3
expect 2 "nothing.yaml" check nothing.yaml
expect 2 "density" check misspelt.yaml
expect 2 "step" check unstable.yaml
if [ "$(id -u)" -ne 0 ]; then
    cp small.yaml secret.yaml
    chmod 000 secret.yaml
    expect 2 "secret.yaml" run secret.yaml
fi
if compgen -G '*.run' >/dev/null; then
    echo "a wrong scene left a run directory" >&2
    failures=$((failures + 1))
fi

# check writes nothing.
expect 0 "stable step" check small.yaml
expect 0 "estimated time" check small.yaml --set time.end=0.2 --threads 1
expect 0 "left " check small.yaml --no-timing
if compgen -G '*.run' >/dev/null; then
    echo "check wrote something" >&2
    failures=$((failures + 1))
fi

# run, in the default directory and in a given one.
expect 0 "results in small.run" run small.yaml
for file in scene.used.yaml summary.json series/left.csv frames/picture_000002.vtp frames/picture.pvd frames/picture.contacts.pvd checkpoint/000001000.h5; do
    expect_file "small.run/$file"
done
expect 2 "holds a run already" run small.yaml
expect 0 "done" run small.yaml --overwrite
expect 0 "done" run small.yaml -o deep/down/here --until 0.05 --set title=other
expect 1 "small.yaml" run small.yaml -o small.yaml/below
expect 2 "is a file" resume small.yaml
if [ -n "$("$PARTICLS" run small.yaml -o quiet --quiet)" ]; then
    echo "run --quiet is not quiet" >&2
    failures=$((failures + 1))
fi

# resume
expect 0 "has finished" resume small.run
expect 0 "results in deep/down/here" resume deep/down/here --until 0.1
expect 2 "no_such_folder" resume no_such_folder
mkdir -p nothing
expect 2 "no run has begun" resume nothing
if ! cmp -s small.run/series/left.csv deep/down/here/series/left.csv; then
    echo "a run in two parts differs from one in one" >&2
    failures=$((failures + 1))
fi

# info
expect 0 "finished" info small.run
expect 0 "checksum           good" info small.run/checkpoint/000001000.h5
expect 0 "velocity" info small.run/checkpoint/000001000.h5
expect 0 "points             2" info small.run/frames/picture_000000.vtp
expect 0 "rows               11" info small.run/series/left.csv
expect 2 "particls check" info small.yaml
expect 2 "no_such_file" info no_such_file
expect 2 "no scene.used.yaml" info nothing
head -c 3000 small.run/checkpoint/000001000.h5 >cut.h5
expect 1 "cut off" info cut.h5
expect 2 "is no run directory" info "$0"

# schema and plugin
expect 0 '"$schema"' schema
expect 0 "hex_pack" schema --reference
expect 0 '`angular_velocity`' schema --fields
expect 2 "exclude each other" schema --fields --reference
expect 0 "-ffp-contract=off" plugin --cflags

# A program that cannot write what it prints must not say that all is well.
if [ -w /dev/full ]; then
    if "$PARTICLS" schema >/dev/full 2>/dev/null; then
        echo "schema to a full disk: exit status 0" >&2
        failures=$((failures + 1))
    fi
fi

# A step that fails leaves no numbers that belong to no moment.
expect 1 "overlap" run clash.yaml -o clash.run
for value in '"finished": false' '"energies": null' '"momentum": null' '"state_hash": null'; do
    grep -qF "$value" clash.run/summary.json || { echo "after a failed step $value is not in the summary" >&2; failures=$((failures + 1)); }
done

# What other programs read.
if command -v python3 >/dev/null; then
    python3 - <<'PYTHON' || failures=$((failures + 1))
import json, re, subprocess, os
import xml.etree.ElementTree as tree
summary = json.load(open("small.run/summary.json"))
assert summary["finished"] is True and summary["bodies"] == 2 and summary["steps"] == 1000, summary
assert abs(summary["momentum"][0] - 1000 * 4 / 3 * 3.141592653589793 * 0.1**3) < 1e-9, summary["momentum"]
assert set(summary["observers"]) == {"left", "picture"}, summary["observers"]
for name in ("picture_000000.vtp", "picture.contacts_000000.vtp"):
    data = open("small.run/frames/" + name, "rb").read()
    head = data[:data.index(b"<AppendedData")].decode() + "</VTKFile>"  # raw data is no XML
    tree.fromstring(head)
for collection in ("picture.pvd", "picture.contacts.pvd"):
    for entry in tree.parse("small.run/frames/" + collection).iter("DataSet"):
        assert os.path.exists("small.run/frames/" + entry.get("file")), entry.get("file")
json.loads(subprocess.run([os.environ["PARTICLS"], "schema"], capture_output=True, check=True).stdout)
PYTHON
fi

if [ $failures -gt 0 ]; then
    echo "$failures failed" >&2
    exit 1
fi
