"""ricochet_bench prints one JSON line per scenario with seconds, repeats, tasks and n."""
import json
import subprocess
import sys

lines = subprocess.run([sys.argv[1], "table", "ring_prime"], check=True, capture_output=True,
                       text=True).stdout.splitlines()
rows = [json.loads(line) for line in lines]
assert [r["scenario"] for r in rows] == ["table", "ring_prime"], rows
assert all(r["seconds"] > 0 and r["repeats"] > 0 and r["tasks"] > 0 and r["n"] > 0 for r in rows), rows
unknown = subprocess.run([sys.argv[1], "no_such_scenario"], capture_output=True, text=True)
assert unknown.returncode == 2 and "no such scenario" in unknown.stderr
print("2 passed, 0 failed")
