#!/usr/bin/env python3
"""The gyrovertical beside VQF, on recordings of a hand-held sensor with cameras as truth.

usage: compare_vqf.py excerpts MERIDIAN [LIMIT]     the excerpts kept in data/recordings/imu-broad-*.csv.gz
       compare_vqf.py trials BROAD MERIDIAN [HALF]  the trials in a clone of https://github.com/dlaidig/broad (CC BY 4.0)

MERIDIAN is the built command (target/release/meridian). LIMIT, rad/s, makes the gyros soft: they show
LIMIT tanh(rate / LIMIT). HALF is a or b (places 1, 3, 5... and 2, 4, 6... of the trials that can be read), apart (b
without those of the excerpts), or all, as without it.
Needs numpy, scipy and vqf (2.1, MIT): the class VQF in its default setting, 6 axes, sample by sample as a board could
run it. Both get the same samples and nothing but the sample rate.

Errors as BROAD defines them: the angle between the verticals, and the turn about the vertical after one constant offset; RMS over the
samples that move and have a truth. Coverage: per cent of samples whose inclination is below 1, 2, 3 times sqrt(2) sigma; two equal
Gaussian tilts give 63, 98, 100 %.
"""
import glob
import gzip
import io
import os
import subprocess
import sys
import tempfile

import numpy as np

FLIP = np.array([1, -1, -1.0])                          # forward, right, down <-> forward, left, up
UP_TO_DOWN = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1.0]])  # east, north, up -> north, east, down
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'data', 'recordings')


def matrices(q):
    """Rotation matrices of quaternions (w, x, y, z), one a row."""
    w, x, y, z = q.T
    return np.stack([
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1).reshape(-1, 3, 3)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def errors(found, truth):
    """Inclination and heading errors, degrees, of rotation matrices from body to level axes."""
    off = found @ truth.transpose(0, 2, 1)
    heading = np.degrees(np.unwrap(np.arctan2(off[:, 1, 0], off[:, 0, 0])))
    return np.degrees(np.arccos(np.clip(off[:, 2, 2], -1, 1))), heading - heading.mean()


def excerpts():
    """Name, rate, rates, forces (forward, right, down), true matrices and where they count."""
    for path in sorted(glob.glob(os.path.join(DATA, 'imu-broad-*.csv.gz'))):
        with gzip.open(path, 'rt') as file:
            lines = file.read().splitlines()
        rate = next(float(line.split(':')[1]) for line in lines if line.startswith('# rate_hz'))
        table = np.genfromtxt([line for line in lines if not line.startswith('#')][1:], delimiter=',')
        truth = matrices(table[:, 7:11])
        counts = (table[:, 11] > 0) & ~np.isnan(table[:, 7])
        yield os.path.basename(path)[:-7], rate, table[:, 0], table[:, 1:4], table[:, 4:7], truth, counts


def trials(folder, half):
    """The same of the whole trials in a clone, as far as their files are there."""
    from scipy.io import loadmat
    listed = subprocess.run(['git', '-C', folder, 'ls-tree', '--name-only', 'HEAD', 'data_mat/'], capture_output=True, check=True)
    kept = [name[-2:] for name, *_ in excerpts()]
    place = 0
    for path in sorted(listed.stdout.decode().split()):
        stored = subprocess.run(['git', '-C', folder, 'show', 'HEAD:' + path], capture_output=True)
        if not path.endswith('.mat') or stored.returncode:
            continue
        place += 1
        side = 'ab'[(place - 1) % 2]
        is_apart = side == 'b' and os.path.basename(path)[:2] not in kept
        if half not in ('all', side) and not (half == 'apart' and is_apart):
            continue
        data = loadmat(io.BytesIO(stored.stdout), squeeze_me=True)
        rate = float(data['sampling_rate'])
        time = np.arange(len(data['imu_gyr'])) / rate
        truth = UP_TO_DOWN @ matrices(data['opt_quat']) @ np.diag(FLIP)
        counts = data['movement'].astype(bool) & ~np.isnan(data['opt_quat'][:, 0])
        yield os.path.basename(path)[:-4], rate, time, data['imu_gyr'] * FLIP, data['imu_acc'] * FLIP, truth, counts


def kept(meridian, rate, time, rates, forces):
    """Attitudes that the command keeps, as matrices, and 1 sigma of a tilt, degrees."""
    with tempfile.TemporaryDirectory() as folder:
        recording, attitude = os.path.join(folder, 'imu.csv'), os.path.join(folder, 'attitude.csv')
        with open(recording, 'w') as file:
            file.write(f'# kind: imu\n# rate_hz: {rate:.6f}\nt_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n')
            np.savetxt(file, np.column_stack([time, rates, forces]), delimiter=',', fmt=['%.5f'] + ['%.6f'] * 3 + ['%.5f'] * 3)
        words = [meridian, 'replay', recording, '--method', 'vertical', '--attitude-out', attitude]
        finished = subprocess.run(words, capture_output=True, text=True)
        if not os.path.exists(attitude):
            sys.exit(finished.stderr)
        table = np.loadtxt(attitude, delimiter=',', skiprows=1)
    return matrices(table[:, 1:5]), np.degrees(table[:, 5])


def compare(recordings, meridian, limit=None):
    from vqf import VQF
    rows, pooled = [], []
    for name, rate, time, rates, forces, truth, counts in recordings:
        if limit:
            rates = limit * np.tanh(rates / limit)
        ours, sigma = kept(meridian, rate, time, rates, forces)
        theirs = VQF(1 / rate).updateBatch(*(np.ascontiguousarray(part * FLIP) for part in (rates, forces)))['quat6D']
        # VQF's quaternions are from forward, left, up to a level frame whose z is up.
        theirs = np.diag(FLIP) @ matrices(theirs) @ np.diag(FLIP)
        inclination, heading = errors(ours[counts], truth[counts])
        their_inclination, their_heading = errors(theirs[counts], truth[counts])
        pooled.append(inclination / (np.sqrt(2) * sigma[counts]))
        rows.append([rms(part) for part in (inclination, their_inclination, heading, their_heading)])
        print('{:44s} inclination {:6.3f} (VQF {:5.3f})  heading {:6.3f} (VQF {:5.3f})'.format(name, *rows[-1]))
    ours, theirs, heading, their_heading = np.array(rows).T
    print(f'{len(rows)} recordings: inclination {ours.mean():.3f}, worst {ours.max():.2f} (VQF {theirs.mean():.3f}, {theirs.max():.2f}); '
          f'heading {heading.mean():.2f} (VQF {their_heading.mean():.2f}); greatest ratio of inclinations {(ours / theirs).max():.2f}')
    pooled = np.concatenate(pooled)
    within = ', '.join(f'{100 * np.mean(pooled <= k):.1f}' for k in (1, 2, 3))
    print(f'within 1, 2, 3 sigma {within} %; RMS of error / (sqrt(2) sigma) {rms(pooled):.2f}')


HALF = (sys.argv + ['all'])[4] if len(sys.argv) > 3 else 'all'
if __name__ == '__main__' and len(sys.argv) > 2 and sys.argv[1] == 'excerpts':
    compare(excerpts(), sys.argv[2], *map(float, sys.argv[3:]))
elif __name__ == '__main__' and len(sys.argv) > 3 and sys.argv[1] == 'trials' and HALF in ('a', 'b', 'apart', 'all'):
    compare(trials(sys.argv[2], HALF), sys.argv[3])
else:
    sys.exit(__doc__)
