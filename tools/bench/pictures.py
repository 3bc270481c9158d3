"""Pictures in and out with Python's own library: flat sequences of RGB floats, rows from the top."""
import array
import itertools
import struct
import sys
import zlib


def read_raw(path, width, height):
    """Little-endian floats, as the peers' scripts write them."""
    values = array.array("f", path.read_bytes())
    if sys.byteorder == "big":
        values.byteswap()
    if len(values) != 3 * width * height:
        raise ValueError(f"{path}: {len(values)} numbers for {width} x {height} pixels")
    return values


def string(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def exr_header(data):
    """Attributes as bytes by name, and where the table of offsets begins."""
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("not an OpenEXR file")
    at, attributes = 8, {}
    while data[at]:
        name, at = string(data, at)
        _, at = string(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def exr_channels(data):
    """[(name, bytes a value)] in the file's order."""
    at, channels = 0, []
    while data[at]:
        name, at = string(data, at)
        kind, = struct.unpack_from("<i", data, at)
        channels.append((name, {1: 2, 2: 4}[kind]))
        at += 16
    return channels


def unzip(block, size):
    """OpenEXR's ZIP: differences of bytes, the even ones first. A block that would not shrink is stored as it is."""
    if len(block) == size:
        return block
    data = bytes(itertools.accumulate(zlib.decompress(block), lambda a, b: (a + b - 128) & 255))
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2], out[1::2] = data[:half], data[half:]
    return bytes(out)


def read_exr(path):
    """R, G and B of a file with ZIP-compressed scanlines, as kiln writes it: (values, width, height)."""
    data = path.read_bytes()
    attributes, table = exr_header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    if attributes["compression"] != b"\x03":
        raise ValueError(f"{path}: not compressed by ZIP")
    channels = exr_channels(attributes["channels"])
    width, height, lines = x1 - x0 + 1, y1 - y0 + 1, 16
    row = sum(size for _, size in channels) * width
    values = array.array("f", bytes(12 * width * height))
    for block in range((height + lines - 1) // lines):
        offset, = struct.unpack_from("<Q", data, table + 8 * block)
        first, size = struct.unpack_from("<2i", data, offset)
        here = min(lines, y1 + 1 - first)
        unpacked = unzip(data[offset + 8:offset + 8 + size], row * here)
        for line in range(here):
            at = row * line
            for name, size in channels:
                if name in ("R", "G", "B"):
                    start = 3 * width * (first - y0 + line) + "RGB".index(name)
                    values[start:start + 3 * width:3] = array.array("f", struct.unpack_from(
                        f"<{width}{'e' if size == 2 else 'f'}", unpacked, at))
                at += size * width
    return values, width, height


def srgb(value):
    value = min(max(value, 0.0), 1.0)
    return round(255 * (12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055))


def write_png(path, pictures, width, height):
    """Pictures of one size side by side, with the curve of sRGB."""
    rows = bytearray()
    for y in range(height):
        rows += b"\0"
        for picture in pictures:
            rows += bytes(srgb(v) for v in picture[3 * width * y:3 * width * (y + 1)])
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">2I5B", width * len(pictures), height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(rows)))
                     + chunk(b"IEND", b""))


def luminance(picture):
    """Mean over the picture, of linear Rec.709."""
    weights = (0.2126, 0.7152, 0.0722)
    return sum(w * sum(picture[k::3]) for k, w in enumerate(weights)) * 3 / len(picture)
