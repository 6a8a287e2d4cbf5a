"""The library for Python against a folder of the program: the same run has the same state, samples and results."""

import csv
import json
import sys

import grainfall
import numpy as np

folder = sys.argv[1]
with open(f"{folder}/summary.json", encoding="utf-8") as file:
    summary = json.load(file)

assert "small-drum" in grainfall.scenes()
scene = grainfall.Scene("small-drum")
run = grainfall.Run(scene, threads=2)
assert run.time == 0.0 and run.step == 0
run.set("friction.glass.glass", 0.2)
for _ in range(3):
    run.advance(0.1)
assert run.hash == summary["state_hash"], (run.hash, summary["state_hash"])

series, units = run.series(), dict(run.units())
with open(f"{folder}/series.csv", encoding="utf-8") as file:
    rows = list(csv.DictReader(file))
assert len(series["time"]) == len(rows)
for name, unit in units.items():
    column = np.array([float(row[f"{name} [{unit}]"] or "nan") for row in rows])
    assert np.array_equal(series[name], column, equal_nan=True), name

found = run.results()
for stated in summary["results"]["entries"]:
    assert found[stated["name"]]["value"] == stated["value"], stated
    assert found[stated["name"]]["unit"] == stated["unit"]

grains, contacts = run.grains(), run.contacts()
count = scene.grain_count
assert grains["position"].shape == (count, 3) and grains["radius"].shape == (count,)
assert grains["contact_count"].sum() > 0 and len(contacts["grain"]) == len(contacts["force"])
# The weight of the bed is what the walls carry, but for what is on the move.
walls = contacts["force"][contacts["partner"] < 0].sum(axis=0)
weight = grains["mass"].sum() * 9.81
assert abs(walls[1] / weight - 1) < 0.2, (walls, weight)

# A live parameter acts from the moment of the change on.
scene.set("drum-speed", "6rpm")
runs = [grainfall.Run(scene) for _ in range(2)]
runs[1].set("gravity", 3.0)
for other in runs:
    other.advance(0.01)
assert runs[0].hash != runs[1].hash and runs[0].step == runs[1].step
turned = grainfall.Run(grainfall.Scene("small-drum"))
turned.set("drum-speed", "6rpm")
turned.advance(0.01)
assert turned.hash == runs[0].hash

# A state that was read stays what it was.
position = grains["position"].copy()
run.advance(0.01)
assert np.array_equal(position, grains["position"]) and not np.array_equal(position, run.grains()["position"])

for wrong, word in [
    (lambda: grainfall.Scene("smal-drum"), "small-drum"),
    (lambda: grainfall.Scene.parse("(title: 3)"), "title"),
    (lambda: scene.set("drum-sped", 1), "drum-speed"),
    (lambda: scene.set("drum-speed", "fast"), "rpm"),
    (lambda: run.set("friction.glass.wood", 1), "wood"),
    (lambda: run.advance(-1), "-1"),
    (lambda: run.advance(float("nan")), "nan"),
]:
    try:
        wrong()
    except ValueError as error:
        assert word in str(error).lower(), error
    else:
        raise AssertionError(f"nothing was refused where {word!r} was wrong")
print(f"the same state {run.hash[:12]}… went on from {summary['state_hash'][:12]}…, {len(rows)} samples, {len(found)} results")
