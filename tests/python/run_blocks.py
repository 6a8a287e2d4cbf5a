"""Runs the Python blocks of a document, each on its own, in the order in which they stand."""

import re
import sys
import warnings

warnings.filterwarnings("ignore", message=".*OVITO.*PyPI")
document = open(sys.argv[1], encoding="utf-8").read()
blocks = re.findall(r"^```python\n(.*?)^```", document, re.MULTILINE | re.DOTALL)
assert blocks, "no blocks"
for number, block in enumerate(blocks, 1):
    print(f"-- block {number} of {len(blocks)}: {len(block.splitlines())} lines")
    exec(compile(block, f"{sys.argv[1]}, block {number}", "exec"), {"__name__": "__main__"})
