# SPDX-License-Identifier: AGPL-3.0-or-later
"""Reads the picture files that povray writes, with nothing of povray's: Python's own library, and djpeg for JPEG.

read(path) gives a Picture. Only what povray writes is understood; anything else is an error.
"""
import itertools
import struct
import subprocess
import zlib


class Picture:
	"""pixels: a tuple of numbers each, row by row from the top; names: their channels, of "RGBAY".

	most is what an integer sample counts as one, None for floats. notes: what else the file says of its pixels;
	when, with what version and on what machine it was made is left out.
	"""

	def __init__(self, width, height, names, most, pixels, **notes):
		self.width, self.height, self.names, self.most, self.notes = width, height, names, most, notes
		self.pixels = list(pixels)
		assert len(self.pixels) == width * height, (width, height, len(self.pixels))

	def same(self, other):
		return vars(self) == vars(other)

	def rgba(self):
		"""Every pixel as red, green, blue, alpha; one is one."""
		scale = 1 / self.most if self.most else 1
		order = [self.names.find("Y" if "Y" in self.names and c != "A" else c) for c in "RGBA"]
		return [tuple(1.0 if i < 0 else p[i] * scale for i in order) for p in self.pixels]


PNG_CHANNELS = {0: "Y", 2: "RGB", 4: "YA", 6: "RGBA"}


def tuples(flat, n):
	return zip(*[iter(flat)] * n)


def words(data, order):
	return struct.unpack(f"{order}{len(data) // 2}H", data)


def unpacked_png(data):
	"""(width, height, bits, colour type), the other chunks by their names, and the bytes of the rows (ISO/IEC 15948)."""
	assert data[:8] == b"\x89PNG\r\n\x1a\n"
	at, chunks, packed = 8, {}, b""
	while at < len(data):
		size, kind = struct.unpack(">I4s", data[at:at + 8])
		body = data[at + 8:at + 8 + size]
		assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0], kind
		if kind == b"IDAT":
			packed += body
		else:
			chunks[kind.decode()] = body
		at += 12 + size
	width, height, bits, colour = head = struct.unpack(">IIBB", chunks.pop("IHDR")[:10])
	step = len(PNG_CHANNELS[colour]) * bits // 8
	stride = width * step
	raw, above, out = zlib.decompress(packed), bytes(stride), []
	for row in range(height):
		line = bytearray(raw[row * (stride + 1) + 1:(row + 1) * (stride + 1)])
		method = raw[row * (stride + 1)]
		for i in range(stride):
			a, b, c = (line[i - step] if i >= step else 0), above[i], (above[i - step] if i >= step else 0)
			to_a, to_b, to_c = abs(b - c), abs(a - c), abs(a + b - 2 * c)
			near = a if to_a <= to_b and to_a <= to_c else b if to_b <= to_c else c
			line[i] = (line[i] + (0, a, b, (a + b) // 2, near)[method]) & 255
		out.append(line)
		above = line
	return head, chunks, b"".join(out)


def png(data):
	(width, height, bits, colour), chunks, out = unpacked_png(data)
	names = PNG_CHANNELS[colour]
	flat = out if bits == 8 else words(out, ">")
	notes = {k: v for k, v in chunks.items() if k not in ("tIME", "tEXt", "IEND")}
	return Picture(width, height, names, 2**bits - 1, tuples(flat, len(names)), **notes)


def ppm(data):
	tokens, at = [], 0
	while len(tokens) < 4:
		end = data.index(b"\n", at)
		if data[at:at + 1] != b"#":
			tokens += data[at:end].split()
		at = end + 1
	names = {b"P5": "Y", b"P6": "RGB"}[tokens[0]]
	width, height, most = map(int, tokens[1:])
	flat = data[at:] if len(data) - at == width * height * len(names) else words(data[at:], ">")
	return Picture(width, height, names, most, tuples(flat, len(names)))


def bmp(data):
	start, = struct.unpack("<I", data[10:14])
	width, height, planes, bits, packing = struct.unpack("<IIHHI", data[18:34])
	assert data[:2] == b"BM" and planes == 1 and packing == 0
	n = bits // 8
	stride = (width * n + 3) // 4 * 4
	rows = [data[start + y * stride:start + y * stride + width * n] for y in reversed(range(height))]
	return Picture(width, height, "BGRA"[:n], 255, tuples(b"".join(rows), n), header=data[:start])


def targa(data):
	width, height, bits, flags = struct.unpack("<HHBB", data[12:18])
	n, at, flat = bits // 8, 18 + data[0], []
	assert flags & 0x30 == 0x20, "not from the top left"
	if data[2] == 2:
		flat = data[at:at + width * height * n]
	else:
		assert data[2] == 10
		while len(flat) < width * height * n:
			head, at = data[at], at + 1
			count, runs = (head & 127) + 1, head & 128
			flat += data[at:at + n] * count if runs else data[at:at + n * count]
			at += n if runs else n * count
	# Of the extension area behind the pixels: the kind of alpha, and gamma.
	extension, = struct.unpack("<I", data[-26:-22])
	area = data[extension:]
	return Picture(width, height, "BGRA"[:n], 255, tuples(flat, n), header=data[:18], alpha=area[494], gamma=area[478:482])


def hdr(data):
	head, size, body = data.split(b"\n\n", 1)[0], *data.split(b"\n\n", 1)[1].split(b"\n", 1)
	assert head.startswith(b"#?RADIANCE") and b"FORMAT=32-bit_rle_rgbe" in head
	_, height, _, width = size.split()
	width, height, at, pixels = int(width), int(height), 0, []
	for _ in range(height):
		if width < 8:
			row, at = list(tuples(body[at:at + 4 * width], 4)), at + 4 * width
		else:
			assert struct.unpack(">HH", body[at:at + 4]) == (0x202, width)
			at, flat = at + 4, []
			while len(flat) < 4 * width:
				count, at = body[at], at + 1
				run = count - 128 if count > 128 else 0
				flat += body[at:at + 1] * run if run else body[at:at + count]
				at += 1 if run else count
			row = zip(*[flat[c * width:(c + 1) * width] for c in range(4)])
		# A mantissa stands for the middle of its step.
		pixels += [tuple((m + 0.5) * 2.0**(e - 136) if e else 0.0 for m in rgb) for *rgb, e in row]
	return Picture(width, height, "RGB", None, pixels)


def exr(data):
	assert data[:8] == b"v/1\x01\x02\0\0\0", "not a single-part scan-line file"
	at, attributes = 8, {}
	while data[at]:
		name, kind, rest = data[at:].split(b"\0", 2)
		at += len(name) + len(kind) + 2
		size, = struct.unpack("<I", data[at:at + 4])
		attributes[name.decode()] = data[at + 4:at + 4 + size]
		at += 4 + size
	x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
	width, height = x1 - x0 + 1, y1 - y0 + 1
	channels, rest = [], attributes["channels"]
	while rest[0]:
		name, rest = rest.split(b"\0", 1)
		kind, _, x_step, y_step = struct.unpack("<iiii", rest[:16])
		assert (x_step, y_step) == (1, 1)
		channels.append((name.decode(), {1: "e", 2: "f"}[kind]))
		rest = rest[16:]
	assert attributes["compression"] == b"\3", "not ZIP, 16 lines a block"
	size = width * sum(struct.calcsize(c) for _, c in channels)
	pixels = []
	for offset in struct.unpack(f"<{(height + 15) // 16}Q", data[at + 1:at + 1 + (height + 15) // 16 * 8]):
		y, packed = struct.unpack("<ii", data[offset:offset + 8])
		lines, block = min(16, y1 + 1 - y), data[offset + 8:offset + 8 + packed]
		if packed < size * lines: # else as it is
			block = zlib.decompress(block)
			block = bytes(b & 255 for b in itertools.accumulate(block, lambda a, b: a + b - 128))
			half = (len(block) + 1) // 2
			block = bytes(b for pair in itertools.zip_longest(block[:half], block[half:]) for b in pair if b is not None)
		for line in range(lines):
			row, columns = block[line * size:(line + 1) * size], []
			for _, code in channels:
				columns.append(struct.unpack(f"<{width}{code}", row[:width * struct.calcsize(code)]))
				row = row[width * struct.calcsize(code):]
			pixels += zip(*columns)
	notes = {k: v for k, v in attributes.items() if k not in ("creation", "comments")}
	return Picture(width, height, "".join(n for n, _ in channels), None, pixels, kinds="".join(c for _, c in channels), **notes)


def jpeg(data):
	decoded = subprocess.run(["djpeg", "-pnm"], input=data, stdout=subprocess.PIPE, check=True).stdout
	return ppm(decoded)


READERS = {"png": png, "ppm": ppm, "bmp": bmp, "tga": targa, "hdr": hdr, "exr": exr, "jpg": jpeg}


def read(path):
	with open(path, "rb") as file:
		return READERS[path.rsplit(".", 1)[1]](file.read())
