#!/usr/bin/env python3
"""Writes allan-long.json: overlapping Allan deviations of eight million samples, by allantools.

Part of Meridian, MIT OR Apache-2.0; needs numpy and allantools (2024.6). The series is one of integers, so that
tests/recordings/allan_host/estimators.rs makes the same one bit for bit.
"""

import json
from pathlib import Path

import allantools
import numpy as np

SAMPLES = 8_000_000
MULTIPLIER, INCREMENT = 6364136223846793005, 1442695040888963407
BIAS = 1 << 30


def states(count):
    """The states of a linear congruence modulo 2^64 behind the state 1."""
    powers = np.full(count, MULTIPLIER, dtype=np.uint64)
    np.multiply.accumulate(powers, out=powers)
    sums = np.concatenate((np.ones(1, dtype=np.uint64), powers[:-1]))
    np.add.accumulate(sums, out=sums)
    return powers + np.uint64(INCREMENT) * sums


def series(count):
    """A bias, white noise of 24 bits, and a walk of steps of 1024 up or down."""
    state = states(count)
    white = (state >> np.uint64(40)).astype(np.int64) - (1 << 23)
    steps = 1024 * (2 * ((state >> np.uint64(36)) & np.uint64(1)).astype(np.int64) - 1)
    return BIAS + white + np.cumsum(steps)


def factors(count):
    """1, 2, 3, 4, 6, 8, 12, ... as far as two windows fit."""
    octaves = [factor << k for k in range(1, 62) for factor in (2, 3)]
    return [factor for factor in [1, 2, 3, *octaves] if factor <= count // 2]


def main():
    rates = series(SAMPLES).astype(np.float64)
    wanted = factors(SAMPLES)
    found, deviations, _, terms = allantools.oadev(rates, rate=1.0, data_type="freq", taus=wanted)
    assert [round(tau) for tau in found] == wanted
    document = {
        "source": f"allantools {allantools.__version__}, oadev, by allan-long.py",
        "samples": SAMPLES,
        "last": int(series(SAMPLES)[-1]),
        "oadev": {str(factor): float(deviation) for factor, deviation in zip(wanted, deviations)},
    }
    Path(__file__).with_suffix(".json").write_text(json.dumps(document, indent=1) + "\n")


if __name__ == "__main__":
    main()
