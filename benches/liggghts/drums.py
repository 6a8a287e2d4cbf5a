#!/usr/bin/env python3
"""Drums in LIGGGHTS beside ours: the same settled beds, in the frame of the drum, measured as our runs are.

    benches/liggghts/drums.py target/release/grainfall out/liggghts --seeds 1..6 --liquids 0,1,7

For every bed and liquid this exports the drum (bridges as coded), lets the walls rest as primitives and gravity turn,
runs `liggghts` on one process, turns its dumps back into the laboratory's frame and imports them; then it runs the same
drum here. What is done already is left alone, so that it can be called again, and by two at once for different seeds.
In the end it prints means over the beds with their standard errors, 20 to 50 s, and the differences.

Why the frame of the drum: LIGGGHTS turns neither tangential springs nor rolling torques with a bed that turns as a
whole (docs/validation.md), and walls as primitives take half the time of meshes. Centrifugal and Coriolis forces, up
to 0.002 % and 0.3 % of the weight, are left out.
"""

import argparse
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
    "surface angle": ("θ [°]", 180 / math.pi, 2),
    "drop Δθ": ("Δθ [°]", 180 / math.pi, 2),
    "avalanches": ("drops", 1, 1),
    "avalanche period": ("time between drops [s]", 1, 2),
    "granular temperature": ("⟨Tg⟩ [10⁻⁶ m²/s²]", 1e6, 2),
    "non-rigid share ta/ts": ("ta/ts", 1, 3),
    "co-rotating non-rigid share ta/ts′": ("ta/ts′", 1, 3),
    "packing fraction": ("φ", 1, 4),
    "coordination number": ("Z", 1, 3),
}


def results(folder: Path) -> list[dict] | None:
    """The results of a run; none where it has not ended."""
    summary = folder / "summary.json"
    found = json.loads(summary.read_text())["results"] if summary.exists() else None
    return found and found["entries"]


def value(folder: Path, quantity: str) -> float:
    """A result of a run; NaN where it has none."""
    found = [entry["value"] for entry in results(folder) or [] if entry["name"] == quantity]
    return math.nan if not found or found[0] is None else found[0]


def mean_and_error(values: list[float]) -> tuple[float, float]:
    """The mean and s/√n."""
    mean = sum(values) / len(values)
    square = sum((value - mean) ** 2 for value in values) / (len(values) - 1)
    return mean, math.sqrt(square / len(values))


def compare(folders: dict[int, list[tuple[Path, Path]]]) -> None:
    """Prints both programs' means over the beds, and their differences."""
    for liquid, pairs in folders.items():
        both = [pair for pair in pairs if all(results(folder) for folder in pair)]
        if len(both) < 2:
            continue
        print(f"\nliquid {liquid}, {len(both)} beds\n\n| | LIGGGHTS | ours | difference |\n|---|---|---|---|")
        for quantity, (name, scale, digits) in QUANTITIES.items():
            sides = [[scale * value(pair[side], quantity) for pair in both] for side in (0, 1)]
            (theirs, error), (ours, own_error) = (mean_and_error(side) for side in sides)
            row = [(theirs, error), (ours, own_error), (ours - theirs, math.hypot(error, own_error))]
            print(f"| {name} | " + " | ".join(f"{a:.{digits}f} ± {e:.{digits}f}" for a, e in row) + " |")


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
    parser.add_argument("--seeds", type=numbers, default=numbers("1..6"))
    parser.add_argument("--liquids", type=numbers, default=numbers("0,1,7"))
    parser.add_argument("--radius", default="3mm")
    parser.add_argument("--duration", default="50s")
    parser.add_argument("--table", action="store_true", help="only print what is there")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    grainfall = str(Path(options.grainfall).resolve())
    folders = {liquid: [] for liquid in options.liquids}
    for seed in options.seeds:
        for liquid in options.liquids:
            case = ["--set", f"radius={options.radius}", "--set", f"liquid={liquid}", "--seed", str(seed)]
            case += ["--duration", options.duration]
            name = f"radius={options.radius}_liquid={liquid}_seed={seed}"
            pair = (options.out / name, options.out / f"{name}_ours")
            folders[liquid].append(pair)
            if not options.table:
                run(grainfall, pair[0], [*case, "--output-interval", "0.02s"])
                run_ours(grainfall, pair[1], case)
    compare(folders)


if __name__ == "__main__":
    main()
