"""Writes a result to a disk (tmpfs) that is too small for it, of many sizes: code 3, a message with path and reason,
and no file left; on one that is large enough, a result. Needs root: exits with 77 (skipped) when it cannot mount.

result_full_disk.py MPIEXEC RESULT_RANKS FOLDER
"""
import os
import subprocess
import sys


def write(mpiexec, program, path, ranks):
    command = [mpiexec, "--quiet", "--oversubscribe", "-n", str(ranks), program, path, "30", "20", "30", "2"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stdout + done.stderr


def try_size(mpiexec, program, folder, kilobytes, ranks):
    """Whether the result fitted."""
    path = os.path.join(folder, "a.h5")
    code, text = write(mpiexec, program, path, ranks)
    left = os.listdir(folder)
    if code == 0:
        assert left == ["a.h5"], (kilobytes, left)
        return True
    assert code == 3, (kilobytes, ranks, code, text)
    assert path + ": cannot write" in text and "No space left on device" in text, (kilobytes, text)
    assert left == [], (kilobytes, left)
    return False


def main(mpiexec, program, folder):
    os.makedirs(folder, exist_ok=True)
    fitted = []
    for ranks, kilobytes in [(1, 4), (2, 100), (1, 300), (3, 400), (1, 430), (2, 4000)]:
        mount = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", folder]
        if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            sys.exit(77)
        try:
            fitted.append(try_size(mpiexec, program, folder, kilobytes, ranks))
        finally:
            subprocess.run(["umount", folder], check=True)
    assert not fitted[0] and fitted[-1], fitted


main(*sys.argv[1:])
