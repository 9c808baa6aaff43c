#!/usr/bin/env python3
"""Writes sh_scipy.json: real spherical harmonics by SciPy, in prtkit's convention.

scipy.special.sph_harm(m, l, azimuth, polar) is complex, orthonormal and has the Condon-Shortley
phase. Real, with the phase kept for both signs of m:
  m > 0: sqrt(2) Re Y(l,m),  m < 0: sqrt(2) Im Y(l,|m|),  m = 0: Y(l,0).
SciPy 1.10 (Debian 12: python3-scipy) made the file that is committed.
"""
import json
import math
import pathlib

import numpy
from scipy.special import sph_harm

BAND_COUNT = 16


def real_harmonics(azimuth, polar):
    values = []
    for l in range(BAND_COUNT):
        for m in range(-l, l + 1):
            y = complex(sph_harm(abs(m), l, azimuth, polar))
            values.append(y.real if m == 0 else math.sqrt(2) * (y.real if m > 0 else y.imag))
    return values


generator = numpy.random.default_rng(1)
cases = []
for _ in range(24):
    polar = math.acos(generator.uniform(-1, 1))
    azimuth = generator.uniform(0, 2 * math.pi)
    direction = [math.sin(polar) * math.cos(azimuth), math.sin(polar) * math.sin(azimuth),
                 math.cos(polar)]
    cases.append({"direction": direction, "values": real_harmonics(azimuth, polar)})

path = pathlib.Path(__file__).with_name("sh_scipy.json")
text = ",\n".join(json.dumps(case) for case in cases)
path.write_text('{"band_count": %d, "cases": [\n%s\n]}\n' % (BAND_COUNT, text))
