#!/usr/bin/env python3
"""What the programs print and write as JSON is as docs/schemas says. schemas_test.py SCHEMAS BIN [gpu]"""
import json
import pathlib
import subprocess
import sys
import tempfile

import jsonschema

schemas = pathlib.Path(sys.argv[1])
programs = pathlib.Path(sys.argv[2])
folder = pathlib.Path()
checked = set()


def run(program, *arguments, codes=(0,)):
    """What the program prints, run in the temporary folder."""
    done = subprocess.run([programs / program, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode in codes, (program, arguments, done.returncode, done.stderr)
    return done.stdout


def check(name, text):
    schema = json.loads((schemas / f"{name}.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    jsonschema.validate(json.loads(text), schema)
    checked.add(name)
    # A schema that accepts anything would prove nothing: without its fields the document must be refused.
    for field in schema["required"]:
        broken = json.loads(text)
        del broken[field]
        try:
            jsonschema.validate(broken, schema)
        except jsonschema.ValidationError:
            continue
        raise AssertionError(f"{name}: {field} may be missing")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run("lumicut-scenes", ".", "cornell", "decal")
    run("lumicut-compile", "cornell.glb", "-q", "--report", "plain.json")
    run("lumicut-compile", "decal.glb", "-q", "--report", "full.json", "--compress", "zstd", "--cache", "kept",
        "--sun", "0,-1,0,5")
    if len(sys.argv) > 3:
        for number, mode in enumerate(("reference", "direct")):
            run("lumicut-play", "cornell.lumi", "--headless", "--size", "32x24", "--mode", mode, "--spp", "1",
                "--output", f"{number}.exr", "--stats", "stats.json")
            check("lumicut-play-stats-1", (folder / "stats.json").read_text())
        check("lumicut-compare-1", run("lumicut-compare", "0.exr", "1.exr", "--json"))
        check("lumicut-compare-welch-1",
              run("lumicut-compare", "--welch", "0.exr", "1.exr", "--against", "1.exr", "0.exr", "--json"))
        check("lumicut-bench-rays-1", run("lumicut-bench", "rays", "cornell.lumi", "--size", "32x24", "--repeats", "1",
                                          "--json"))
        check("lumicut-bench-motion-1", run("lumicut-bench", "motion", "cornell.lumi", "--size", "24x16", "--frames", "2",
                                            "--warm-up", "1", "--spp", "1", "--mode", "direct", "--cache", "kept", "--json"))
    else:
        for report in ("plain.json", "full.json"):
            check("lumicut-compile-report-1", (folder / report).read_text())
        for package in ("cornell.lumi", "decal.lumi"):
            check("lumicut-pkg-info-1", run("lumicut-pkg", "info", package, "--format", "json"))
        check("lumicut-pkg-diff-1", run("lumicut-pkg", "diff", "cornell.lumi", "decal.lumi", "--format", "json",
                                        codes=(1,)))
        document = (schemas.parent / "path.md").read_text()
        check("lumicut-path-1", document.split("```json\n")[1].split("```")[0])
        run("lumicut-pkg", "bundle", "cornell.lumi", "-o", "demo.tar.zst", "--player", programs / "lumicut-pkg")
        subprocess.run(["tar", "--zstd", "-xf", "demo.tar.zst"], cwd=folder, check=True)
        check("lumicut-pkg-bundle-manifest-1", (folder / "demo/manifest.json").read_text())
print("checked:", *sorted(checked))
