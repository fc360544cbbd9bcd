"""`meridian allan` beside pandas with allantools on one recording of 8 million rows, and its memory on one of 100 million.

    python host-tests/compare_allan.py MERIDIAN [FOLDER]

Needs numpy, pandas and allantools; writes 0.2 GB into the folder (the present one). Prints both times, their ratio, the
greatest difference of the deviations and the greatest memory; ends with 1 where the command is not twice as quick, differs
by 1 % or more, or takes more than 200 MiB. White noise and a random walk, the same in every run.
"""

import itertools
import json
import os
import subprocess
import sys
import time

import numpy as np

ROWS, MORE_ROWS = 8_000_000, 100_000_000
RATE_HZ = 100
GREATEST_MIB = 200
HEADER = f"# kind: static\n# rate_hz: {RATE_HZ}\nt_s,g_rad_s\n"
# What a user of allantools writes; the averaging times come on standard input.
OTHER = """
import json, sys
import allantools, pandas
taus = json.load(sys.stdin)
rates = pandas.read_csv(sys.argv[1], comment="#")["g_rad_s"].to_numpy()
_, deviations, *_ = allantools.oadev(rates, rate=float(sys.argv[2]), data_type="freq", taus=taus)
print(json.dumps(list(deviations)))
"""


def blocks(rows, size=500_000):
    """CSV rows of a gyro at rest, some hundred thousand at a time."""
    generator, walked = np.random.default_rng(1), 0.0
    for first in range(0, rows, size):
        walk = walked + np.cumsum(generator.normal(0, 1e-10, size))
        walked = walk[-1]
        rates = generator.normal(0, 1e-6, size) + walk
        times = np.arange(first, first + size) / RATE_HZ
        yield "".join(f"{t:.2f},{rate:.6e}\n" for t, rate in zip(times.tolist(), rates.tolist()))


def high_water(process):
    """Greatest memory of a process so far, MiB; none after its end."""
    try:
        with open(f"/proc/{process}/status", encoding="ascii") as status:
            return next((int(line.split()[1]) / 1024 for line in status if line.startswith("VmHWM")), 0.0)
    except FileNotFoundError:
        return 0.0


def run(arguments, given=()):
    """Output, time, s, and greatest memory, MiB, of a program; `given` are the parts of its standard input."""
    begun, memory = time.monotonic(), 0.0
    program = subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    for part in given:
        program.stdin.write(part.encode())
    program.stdin.close()
    while program.poll() is None:
        memory = max(memory, high_water(program.pid))
        time.sleep(0.002)
    if program.returncode != 0:
        sys.exit(f"{arguments[0]} ends with {program.returncode}")
    return json.load(program.stdout), time.monotonic() - begun, memory


def main():
    meridian, folder = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "."
    path = os.path.join(folder, "static.csv")
    with open(path, "w", encoding="utf-8") as file:
        file.write(HEADER)
        file.writelines(blocks(ROWS))
    print(f"{ROWS / 1e6:.0f} million rows, {os.path.getsize(path) / 1e6:.0f} MB")
    ours = [run([meridian, "allan", path, "--json"]) for _ in range(3)]
    found, seconds, memory = min(ours, key=lambda one: one[1])
    taus = json.dumps(found["tau_s"])
    theirs = [run([sys.executable, "-c", OTHER, path, str(RATE_HZ)], [taus]) for _ in range(2)]
    deviations, their_seconds, their_memory = min(theirs, key=lambda one: one[1])
    os.remove(path)
    expected = np.degrees(deviations) * 3600
    off = np.abs(np.array(found["adev_deg_h"]) / expected - 1).max()
    ratio = their_seconds / seconds
    print(f"meridian allan          {seconds:6.2f} s, {memory:5.0f} MiB")
    print(f"pandas and allantools   {their_seconds:6.2f} s, {their_memory:5.0f} MiB: {ratio:.1f} times as long")
    print(f"greatest difference of the deviations {100 * off:.4f} %")
    parts = itertools.chain([HEADER], blocks(MORE_ROWS))
    many, _, more_memory = run([meridian, "allan", "-", "--json"], parts)
    print(f"{many['samples'] / 1e6:.0f} million rows: {more_memory:.0f} MiB")
    good = ratio >= 2 and off < 0.01 and more_memory <= GREATEST_MIB and many["samples"] == MORE_ROWS
    sys.exit(0 if good else 1)


main()
