"""Results that somebody forged: bytes of HDF5's metadata changed, and the checksum of their block made right, so that
HDF5 believes them. The file is of the HDF5 1.10 format throughout (superblock 3, object headers 2)."""

import random
import struct
import subprocess

MASK = 0xFFFFFFFF


def _rotated(x, k):
    return (x << k | x >> (32 - k)) & MASK


def lookup3(data):
    """Jenkins' hash of 2006, the checksum of HDF5's metadata."""
    a = b = c = 0xDEADBEEF + len(data) & MASK
    words = struct.unpack(f"<{-(-len(data) // 12) * 3}I", data + bytes(-len(data) % 12))
    for i in range(0, len(words) - 3, 3):
        a, b, c = a + words[i] & MASK, b + words[i + 1] & MASK, c + words[i + 2] & MASK
        a, c = (a - c ^ _rotated(c, 4)) & MASK, c + b & MASK
        b, a = (b - a ^ _rotated(a, 6)) & MASK, a + c & MASK
        c, b = (c - b ^ _rotated(b, 8)) & MASK, b + a & MASK
        a, c = (a - c ^ _rotated(c, 16)) & MASK, c + b & MASK
        b, a = (b - a ^ _rotated(a, 19)) & MASK, a + c & MASK
        c, b = (c - b ^ _rotated(b, 4)) & MASK, b + a & MASK
    if not words:
        return c
    a, b, c = a + words[-3] & MASK, b + words[-2] & MASK, c + words[-1] & MASK
    for x, k in ((0, 14), (1, 11), (2, 25), (0, 16), (1, 4), (2, 14), (0, 24)):
        if x == 0:
            c = (c ^ b) - _rotated(b, k) & MASK
        elif x == 1:
            a = (a ^ c) - _rotated(c, k) & MASK
        else:
            b = (b ^ a) - _rotated(a, k) & MASK
    return c


def _size_of_header(data, at):
    """Bytes of an object header before its checksum."""
    flags = data[at + 5]
    before = 6 + (16 if flags & 0x20 else 0) + (4 if flags & 0x10 else 0)
    width = 1 << (flags & 3)
    return before + width + int.from_bytes(data[at + before : at + before + width], "little")


# Blocks by their signature, and how many bytes of each its checksum is of.
SIZES = {b"OHDR": _size_of_header, b"BTHD": 34, b"FAHD": 24, b"EAHD": 68, b"FRHP": 142, b"\x89HDF": 44}


def _is_block(data, at, size):
    return 0 < size <= len(data) - at - 4 and lookup3(data[at : at + size]) == _sum_at(data, at + size)


def _sum_at(data, at):
    return struct.unpack_from("<I", data, at)[0]


def _continuations(data, at, size):
    """(place, bytes before the checksum) of the further blocks that an object header may refer to."""
    for i in range(at, at + size - 16):
        to, length = struct.unpack_from("<QQ", data, i)
        if length > 8 and to + length <= len(data) and data[to : to + 4] == b"OCHK":
            yield to, length - 4


def blocks(data):
    """[(place, bytes before the checksum)] of the blocks of metadata with a checksum that is right."""
    found = set()
    for signature, size in SIZES.items():
        at = data.find(signature)
        while at >= 0:
            length = size(data, at) if callable(size) else size
            if _is_block(data, at, length):
                found.add((at, length))
            at = data.find(signature, at + 1)
    waiting = sorted(found)
    while waiting:
        further = {block for block in _continuations(data, *waiting.pop()) if _is_block(data, *block)} - found
        found |= further
        waiting += sorted(further)
    return sorted(found)


def forged(data, block, changes):
    """With bytes of a block changed, {place: byte}, and its checksum made right."""
    new = bytearray(data)
    for at, byte in changes.items():
        new[at] = byte
    at, size = block
    struct.pack_into("<I", new, at + size, lookup3(bytes(new[at : at + size])))
    return bytes(new)


def crowded(data):
    """A group says that the leaf of its index holds 32767 links: HDF5 1.10 reads behind the leaf and crashes."""
    at, size = next(block for block in blocks(data) if data[block[0] : block[0] + 4] == b"BTHD")
    return forged(data, (at, size), {at + 24: 0xFF, at + 25: 0x7F})


def mutants(data, seed):
    """Endlessly many: one to three bytes of a block each."""
    rng, found = random.Random(seed), blocks(data)
    while True:
        at, size = block = rng.choice(found)
        changes = {rng.randrange(at + 4, at + size): rng.choice((0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)))
                   for _ in range(rng.randint(1, 3))}  # fmt: skip
        yield block, changes, forged(data, block, changes)


def look(ricochet, folder, block, changes, data):
    """Shows a mutant in every way; a crash of HDF5 is no end of the program. @returns how many made HDF5 crash"""
    path, crashes = folder / "mutant.h5", 0
    path.write_bytes(data)
    for words in ([], ["--csv"], ["--verify"]):
        shown = ricochet("show", path.name, *words, cwd=folder, out=subprocess.DEVNULL)  # CSV may hold any bytes
        what = f"{block} {changes}: {shown}"
        assert shown.code in (0, 1, 2, 3), what
        assert (shown.code == 0) == (shown.err == ""), what
        assert shown.code == 0 or shown.err.splitlines()[-1].startswith(f"{path.name}: "), what
        crashes += "HDF5 crashed" in shown.err
    return crashes
