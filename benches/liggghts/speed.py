#!/usr/bin/env python3
"""Nanoseconds a grain and step of whole runs, ours and LIGGGHTS', on the same settled beds in one sitting.

    benches/liggghts/speed.py target/release/grainfall out/speed

Ours is the program with all that it does, its time over a span of simulated time by the difference of two durations.
LIGGGHTS' is its loop time over the same span on the exported drum, with walls at rest as primitives, which is faster than
meshes, for skins of 0.1, 0.2 and 0.3 radii on one process. Rounds alternate. Nothing else should run meanwhile.
"""

import argparse
import re
import statistics
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from drums import deck

SKINS = (0.1, 0.2, 0.3)


@dataclass
class Drum:
    name: str
    arguments: list[str]
    radius: float  # [m]
    begin: float  # of the span [s]
    span: float  # [s]


WET = ["wet", "--set", "bridge-law=as-coded"]
DRUMS = [
    Drum("dry r = 3 mm", ["dry-r3"], 3e-3, 0.2, 1.0),
    Drum("dry r = 2 mm", ["dry-r2"], 2e-3, 0.1, 0.4),
    Drum("dry r = 1.25 mm", ["dry-r1.25"], 1.25e-3, 0.02, 0.1),
    Drum("wet r = 3 mm", WET, 3e-3, 0.2, 0.6),
    Drum("wet r = 2 mm", [*WET, "--set", "radius=2mm"], 2e-3, 0.1, 0.2),
    Drum("wet r = 1.25 mm", [*WET, "--set", "radius=1.25mm"], 1.25e-3, 0.02, 0.05),
]


def ours(program: str, drum: Drum, threads: int, out: Path) -> float:
    """Seconds that the program takes for the span."""

    def run(duration: float) -> float:
        where = ["--out", str(out), "--restart", "--quiet", "--threads", str(threads)]
        begin = time.perf_counter()
        command = [program, *drum.arguments, "--no-render", "--duration", f"{duration:g}s", *where]
        subprocess.run(command, check=True)
        return time.perf_counter() - begin

    return run(drum.begin + drum.span) - run(drum.begin)


def export(program: str, drum: Drum, out: Path) -> tuple[float, int]:
    """Exports the drum with walls at rest; its step [s] and number of grains."""
    if not (out / "in.liggghts").exists():
        command = [program, "export", *drum.arguments, "--to", "liggghts", "--out", str(out)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    script = deck((out / "in.liggghts").read_text())
    step = float(re.search(r"^timestep (\S+)", script, re.M)[1])
    script = re.sub(r"^neighbor .*", "neighbor ${skin} bin", script, flags=re.M)
    script = re.sub(r"^(dump|dump_modify|run) .*\n", "", script, flags=re.M)
    steps = [round(time / step) for time in (drum.begin, drum.span)]
    script += "".join(f"run {count}\n" for count in steps)
    (out / "in.speed").write_text(script)
    return step, int(re.search(r"^(\d+) atoms", (out / "grains.data").read_text(), re.M)[1])


def theirs(drum: Drum, skin: float, out: Path) -> float:
    """Seconds of LIGGGHTS' loop over the span."""
    command = ["liggghts", "-in", "in.speed", "-var", "skin", f"{skin * drum.radius:g}"]
    result = subprocess.run(command, cwd=out, check=True, capture_output=True, text=True)
    return float(re.findall(r"^Loop time of (\S+)", result.stdout, re.M)[1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out", type=Path)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--only", default="", help="drums whose name holds this")
    options = parser.parse_args()
    program = str(Path(options.program).resolve())
    print("| ns a grain and step | LIGGGHTS | Grainfall | ratio | two threads | gain |")
    print("|---|---|---|---|---|---|")
    for drum in DRUMS:
        if options.only not in drum.name:
            continue
        out = options.out / drum.name.replace(" ", "")
        out.mkdir(parents=True, exist_ok=True)
        step, grains = export(program, drum, out / "liggghts")
        unit = 1e9 / (grains * round(drum.span / step))
        peer, own, two = [], [], []
        for _ in range(options.rounds):
            own.append(unit * ours(program, drum, 1, out / "ours"))
            two.append(unit * ours(program, drum, 2, out / "ours"))
            peer += [unit * theirs(drum, skin, out / "liggghts") for skin in SKINS]
            own.append(unit * ours(program, drum, 1, out / "ours"))
        cells = [f"{min(peer):.0f}", f"{min(own):.1f} ({statistics.median(own):.1f})", f"{min(peer) / min(own):.1f}"]
        cells += [f"{min(two):.1f}", f"{min(own) / min(two):.2f}"]
        print(f"| {drum.name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
