#!/usr/bin/env python3
"""Drums in LIGGGHTS beside ours: the same settled beds, in the frame of the drum, measured as our runs are.

    benches/liggghts/drums.py target/release/grainfall out/liggghts --seeds 1..7 --kept docs/results/liggghts.csv

For every bed and liquid this exports the drum (bridges as coded), lets the walls rest as primitives and gravity turn,
runs `liggghts` on one process, turns its dumps back into the laboratory's frame and imports them; then it runs the same
drum here. What is done already is left alone, so that it can be called again, and by two at once for different seeds.
In the end it prints means over the beds with their standard errors, of the last three fifths of the time, and the differences.

Why the frame of the drum: LIGGGHTS turns neither tangential springs nor rolling torques with a bed that turns as a
whole (docs/validation.md), and walls as primitives take half the time of meshes. Centrifugal and Coriolis forces, up
to 0.002 % and 0.3 % of the weight, are left out.

`--kept FILE.csv` takes what a run came to from that file, and adds a row for each run that ends.
"""

import argparse
import csv
import fcntl
import itertools
import json
import math
import shutil
import subprocess
from pathlib import Path

SPEED = math.radians(3.0)  # of the drum [rad/s]: 0.5 rpm
RIM, WIDTH = 0.0605, 0.022  # [m]


def deck(exported: str) -> str:
    """The exported script with walls at rest and gravity that turns against the drum."""
    lines = []
    for line in exported.splitlines():
        words = line.split()
        if words[:1] == ["fix"] and ("mesh/surface" in words or "move/mesh" in words):
            continue
        if words[:2] == ["fix", "walls"]:
            model = line.split("wall/gran ")[1].split(" mesh ")[0]
            walls = {
                "rim": f"zcylinder {RIM} 0 0",
                "back": f"zplane {-WIDTH / 2}",
                "front": f"zplane {WIDTH / 2}",
            }
            lines += [f"fix {name} all wall/gran {model} primitive type 2 {wall}" for name, wall in walls.items()]
            continue
        if words[:2] == ["fix", "weight"]:
            lines += [
                f"variable gx equal -sin({SPEED}*step*dt)",
                f"variable gy equal -cos({SPEED}*step*dt)",
                "fix weight all gravity 9.81 vector v_gx v_gy 0",
            ]
            continue
        if words[:1] == ["processors"]:
            line = "processors 1 1 1"
        lines.append(line)
    return "\n".join(lines) + "\n"


def turn_back(dump: Path, step: float) -> None:
    """Turns the positions, velocities and spins of a dump from the drum's frame into the laboratory's."""
    lines = dump.read_text().splitlines()
    time = int(lines[1]) * step
    cos, sin = math.cos(SPEED * time), math.sin(SPEED * time)
    names = lines[8].split()[2:]
    at = {name: names.index(name) for name in names}

    def turned(x: float, y: float) -> tuple[float, float]:
        return cos * x - sin * y, sin * x + cos * y

    for k in range(9, len(lines)):
        row = lines[k].split()
        x, y, vx, vy, wx, wy, wz = (float(row[at[n]]) for n in ("x", "y", "vx", "vy", "omegax", "omegay", "omegaz"))
        new = {}
        new["x"], new["y"] = turned(x, y)
        new["vx"], new["vy"] = turned(vx - SPEED * y, vy + SPEED * x)
        new["omegax"], new["omegay"] = turned(wx, wy)
        new["omegaz"] = wz + SPEED
        for name, value in new.items():
            row[at[name]] = f"{value:.15e}"
        lines[k] = " ".join(row)
    dump.write_text("\n".join(lines) + "\n")


def run(grainfall: str, folder: Path, case: list[str]) -> None:
    """Exports, runs, turns back and imports one drum."""
    if results(folder):
        return
    shutil.rmtree(folder, ignore_errors=True)
    work = folder.with_name(folder.name + ".work")
    shutil.rmtree(work, ignore_errors=True)
    export = [grainfall, "export", "wet", "--to", "liggghts", "--set", "bridge-law=as-coded", *case, "--out", str(work)]
    subprocess.run(export, check=True, stdout=subprocess.DEVNULL)
    script = work / "in.liggghts"
    text = deck(script.read_text())
    script.write_text(text)
    step = float(next(line.split()[1] for line in text.splitlines() if line.startswith("timestep")))
    (work / "dumps").mkdir(exist_ok=True)
    with open(work / "log", "w") as log:
        subprocess.run(["liggghts", "-in", script.name], cwd=work, check=True, stdout=log)
    for dump in (work / "dumps").iterdir():
        turn_back(dump, step)
    measure = [grainfall, "import", str(work), "--out", str(folder)]
    subprocess.run(measure, check=True, stdout=subprocess.DEVNULL)
    timed = next(line for line in (work / "log").read_text().splitlines() if line.startswith("Loop time"))
    print(folder.name, timed, flush=True)
    for states in ("grains", "contacts"):
        shutil.rmtree(folder / states, ignore_errors=True)
    shutil.rmtree(work)


def run_ours(grainfall: str, folder: Path, case: list[str]) -> None:
    """Runs the same drum here, or goes on with it."""
    command = [grainfall, "wet", "--no-render", "--quiet", "--threads", "1", "--set", "bridge-law=as-coded"]
    subprocess.run([*command, *case, "--out", str(folder)], check=True)


QUANTITIES = {
    # a result of a run: its column in the kept file, its name in tables, its unit in SI's, its digits in tables
    "surface angle": ("surface angle [°]", "θ [°]", 180 / math.pi, 2),
    "drop Δθ": ("drop [°]", "Δθ [°]", 180 / math.pi, 2),
    "avalanches": ("drops", "drops", 1, 1),
    "avalanche period": ("time between drops [s]", "time between drops [s]", 1, 2),
    "granular temperature": ("granular temperature [10⁻⁶ m²/s²]", "⟨Tg⟩ [10⁻⁶ m²/s²]", 1e6, 2),
    "non-rigid share ta/ts": ("ta/ts", "ta/ts", 1, 3),
    "co-rotating non-rigid share ta/ts′": ("ta/ts′", "ta/ts′", 1, 3),
    "packing fraction": ("packing fraction", "φ", 1, 4),
    "coordination number": ("coordination number", "Z", 1, 3),
}
PROGRAMS = ("LIGGGHTS 3.8", "Grainfall")
CASE = ["program", "radius [mm]", "liquid", "seed", "from [s]", "to [s]"]


def results(folder: Path) -> dict | None:
    """The results of a run; none where it has not ended."""
    summary = folder / "summary.json"
    return json.loads(summary.read_text())["results"] if summary.exists() else None


def values(folder: Path) -> list[str]:
    """The results of a run that has ended, in the order of the quantities; empty where it has none."""
    found = {entry["name"]: entry["value"] for entry in results(folder)["entries"]}
    numbers = [found.get(name) for name in QUANTITIES]
    return ["" if a is None else f"{a * q[2]:.6g}" for a, q in zip(numbers, QUANTITIES.values())]


class Kept:
    """What runs came to, by program, radius [mm], liquid, seed, and time [s] at which it begins to count and ends."""

    def __init__(self, file: Path | None) -> None:
        self.file, self.rows = file, {}
        if file is None or not file.exists():
            return
        for row in csv.DictReader(file.read_text().splitlines()):
            numbers = [row[column[0]] for column in QUANTITIES.values()]
            self.rows[tuple(row[name] for name in CASE)] = numbers

    def add(self, case: tuple[str, ...], numbers: list[str]) -> None:
        """Adds a run, and writes its row."""
        self.rows[case] = numbers
        if self.file is None:
            return
        with open(self.file, "a") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            writer = csv.writer(file, lineterminator="\n")
            if file.tell() == 0:
                writer.writerow([*CASE, *(column[0] for column in QUANTITIES.values())])
            writer.writerow([*case, *numbers])


def mean_and_error(numbers: list[float]) -> tuple[float, float]:
    """The mean and s/√n."""
    mean = sum(numbers) / len(numbers)
    square = sum((number - mean) ** 2 for number in numbers) / (len(numbers) - 1)
    return mean, math.sqrt(square / len(numbers))


def both_of(kept: Kept, radius: str, liquid: int, seeds: list[int], times: tuple[str, str]) -> list[tuple]:
    """What the beds came to that both programs ran, in each of them."""
    case = [(radius, str(liquid), str(seed), *times) for seed in seeds]
    sides = [[kept.rows.get((name, *rest)) for rest in case] for name in PROGRAMS]
    return [pair for pair in zip(*sides) if all(pair)]


def compared(pairs: list[tuple], quantity: int, digits: int) -> list[str]:
    """A quantity's means over the beds, in LIGGGHTS and here, and their difference; dashes for fewer than two beds."""
    sides = [[float(run[quantity]) for run in side if run[quantity]] for side in zip(*pairs)]
    if len(sides) < 2 or min(len(side) for side in sides) < 2:
        return ["–"] * 3
    (theirs, error), (ours, own_error) = (mean_and_error(side) for side in sides)
    row = [(theirs, error), (ours, own_error), (ours - theirs, math.hypot(error, own_error))]
    return [f"{mean:.{digits}f} ± {error:.{digits}f}".replace("-", "−") for mean, error in row]


def compare(kept: Kept, radius: str, liquids: list[int], seeds: list[int], times: tuple[str, str]) -> None:
    """Prints both programs' means over the beds that both have, and their differences, for each liquid."""
    pairs = {liquid: both_of(kept, radius, liquid, seeds, times) for liquid in liquids}
    names = {0: "dry", 1: "water", 7: "glycerol"}
    head = [f"{names.get(liquid, f'n = {liquid}')}: LIGGGHTS | ours | difference" for liquid in liquids]
    print(f"r = {radius} mm\n\n| | " + " | ".join(head) + " |\n|" + "---|" * (1 + 3 * len(liquids)))
    print("| beds | " + " | ".join(f"{len(both)} | {len(both)} | " for both in pairs.values()) + " |")
    for k, (_, name, _, digits) in enumerate(QUANTITIES.values()):
        print(f"| {name} | " + " | ".join(" | ".join(compared(both, k, digits)) for both in pairs.values()) + " |")


def numbers(text: str) -> list[int]:
    """`1..6` or `0,1,7`."""
    if ".." in text:
        first, last = text.split("..")
        return list(range(int(first), int(last) + 1))
    return [int(number) for number in text.split(",")]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("grainfall")
    parser.add_argument("out", type=Path)
    parser.add_argument("--seeds", type=numbers, default=numbers("1..7"))
    parser.add_argument("--liquids", type=numbers, default=numbers("0,1,7"))
    parser.add_argument("--radius", default="3mm")
    parser.add_argument("--duration", default="50s")
    parser.add_argument("--kept", type=Path, help="a file that keeps the results: *.csv")
    parser.add_argument("--table", action="store_true", help="only print what is there")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    grainfall = str(Path(options.grainfall).resolve())
    kept = Kept(options.kept)
    radius, duration = options.radius.removesuffix("mm"), float(options.duration.removesuffix("s"))
    times = (f"{0.4 * duration:g}", f"{duration:g}")
    for seed, liquid in itertools.product(options.seeds, options.liquids):
        case = ["--set", f"radius={radius}mm", "--set", f"liquid={liquid}", "--seed", str(seed)]
        case += ["--duration", f"{duration:g}s"]
        name = f"radius={radius}mm_liquid={liquid}_seed={seed}"
        runs = [(run, options.out / name, [*case, "--output-interval", "0.02s"])]
        runs += [(run_ours, options.out / f"{name}_ours", case)]
        for program, (compute, folder, arguments) in zip(PROGRAMS, runs):
            key = (program, radius, str(liquid), str(seed), *times)
            if key in kept.rows:
                continue
            if not options.table:
                compute(grainfall, folder, arguments)
            if results(folder):
                kept.add(key, values(folder))
    compare(kept, radius, options.liquids, options.seeds, times)


if __name__ == "__main__":
    main()
