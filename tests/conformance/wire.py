"""What a client of caustream.v1 needs, written from protocol/README.md alone: no code of the project is used.

Debian's python3-websockets does the WebSocket, the standard library the rest.
"""
import asyncio
import hashlib
import json
import re
import struct
import subprocess
import tempfile
import zlib

import websockets

PATIENCE_S = 60

FRAME = struct.Struct("<BBHIHHBBBBIHHHHHBBIIQQIIIIIf")
FRAME_FIELDS = (
    "op header_version header_len frame_seq stream epoch target encoding sample layout flags width height view_width "
    "view_height bands jpeg_quality level input_seq state_rev client_us server_us hold_us render_us encode_us payload_len "
    "raw_len scale"
).split()
CHUNK = struct.Struct("<BBHIQII")
STILL, SCALED, CONVERGED, TEST = 1, 2, 4, 8
JPEG, RAW, PNG = 1, 2, 4


class Closed(Exception):
    """The server has closed: its code and its reason."""

    def __init__(self, code, reason):
        super().__init__(f"closed with {code}: {reason}")
        self.code, self.reason = code, reason


class Frame:
    def __init__(self, message):
        assert len(message) >= FRAME.size, f"a binary message of {len(message)} bytes is no frame"
        self.header = dict(zip(FRAME_FIELDS, FRAME.unpack_from(message)))
        head = self.header
        assert (head["op"], head["header_version"]) == (1, 1), head
        assert head["header_len"] >= 80 and head["header_len"] % 8 == 0, head
        self.payload = message[head["header_len"] :]
        assert len(self.payload) == head["payload_len"], head

    def __getitem__(self, field):
        return self.header[field]


def chunk(asset, offset, payload, crc=None):
    return CHUNK.pack(2, 1, CHUNK.size, asset, offset, len(payload), zlib.crc32(payload) if crc is None else crc) + payload


def png_samples(data):
    """An 8-bit RGB PNG without interlacing, row by row (PNG specification, section 9)."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, size = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack_from(">I", data, at + 8 + length)[0], kind
        if kind == b"IHDR":
            size = struct.unpack(">IIBBBBB", body)
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    width, height, depth, colour = size[:4]
    assert (depth, colour, size[6]) == (8, 2, 0), size
    lines, out, stride = zlib.decompress(packed), [], width * 3
    above = bytearray(stride)
    for y in range(height):
        kind, line = lines[y * (stride + 1)], bytearray(lines[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for x in range(stride):
            left = line[x - 3] if x >= 3 else 0
            corner = above[x - 3] if x >= 3 else 0
            guess = 0
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = above[x]
            elif kind == 3:
                guess = (left + above[x]) // 2
            elif kind == 4:
                toward = left + above[x] - corner
                guess = min((abs(toward - left), 0, left), (abs(toward - above[x]), 1, above[x]), (abs(toward - corner), 2, corner))[2]
            line[x] = (line[x] + guess) & 255
        out.append(bytes(line))
        above = line
    return b"".join(out)


class Client:
    """One WebSocket; messages in the order they came."""

    def __init__(self, socket):
        self.socket = socket
        self.next_id = 1
        self.passed = []  # texts and frames that were skipped while something else was waited for

    @classmethod
    async def connect(cls, port, query=""):
        uri = f"ws://127.0.0.1:{port}/ws{query}"
        socket = await websockets.connect(uri, subprotocols=["caustream.v1"], max_size=None, ping_interval=None, close_timeout=5)
        assert socket.subprotocol == "caustream.v1", socket.subprotocol
        return cls(socket)

    async def close(self):
        await self.socket.close()

    async def send(self, message):
        await self.socket.send(message if isinstance(message, (str, bytes)) else json.dumps(message))

    async def receive(self, seconds=PATIENCE_S):
        """A dict for a text, a Frame for a binary message, None when nothing comes."""
        try:
            message = await asyncio.wait_for(self.socket.recv(), seconds)
        except asyncio.TimeoutError:
            return None
        except websockets.ConnectionClosed:
            raise Closed(self.socket.close_code, self.socket.close_reason) from None
        return Frame(message) if isinstance(message, bytes) else json.loads(message)

    async def until(self, wanted, what, seconds=PATIENCE_S):
        """The first message that `wanted` holds for; those before it go to `passed`."""
        loop = asyncio.get_running_loop()
        end = loop.time() + seconds
        while loop.time() < end:
            message = await self.receive(end - loop.time())
            if message is not None and wanted(message):
                return message
            if message is not None:
                self.passed.append(message)
        raise AssertionError(f"waited in vain for {what}; there came {self.passed[-3:]}")

    async def text(self, op, seconds=PATIENCE_S):
        return await self.until(lambda m: isinstance(m, dict) and m["op"] == op, op, seconds)

    async def frame(self, wanted=lambda frame: True, seconds=PATIENCE_S):
        """The next frame that `wanted` holds for, acknowledged like those before it."""
        end = asyncio.get_running_loop().time() + seconds
        while True:
            left = end - asyncio.get_running_loop().time()
            frame = await self.until(lambda m: isinstance(m, Frame), "a frame", left)
            await self.ack(frame)
            if wanted(frame):
                return frame

    async def ack(self, frame):
        await self.send({"op": "ack", "seq": frame["frame_seq"], "recv_us": 1, "decode_us": 2, "paint_us": 3})

    async def hello(self, **extra):
        message = {"op": "hello", "id": self.take_id(), "client": {"name": "conformance", "version": "1"}}
        message.update({"caps": ["jpeg", "png", "raw", "f16", "f32"], "max_inflight": 2}, **extra)
        await self.send(message)
        self.welcome = await self.until(lambda m: isinstance(m, dict) and m.get("id") == message["id"], "a reply to hello")
        assert self.welcome["op"] == "welcome", self.welcome
        self.state = await self.text("state")
        return self.welcome

    def take_id(self):
        self.next_id += 1
        return self.next_id

    async def ask(self, op, **fields):
        """Exactly one reply has the request's id."""
        number = self.take_id()
        await self.send({"op": op, "id": number, **fields})
        return await self.until(lambda m: isinstance(m, dict) and m.get("id") == number, f"a reply to {op}")

    async def ok(self, op, **fields):
        reply = await self.ask(op, **fields)
        assert reply["op"] == "ok", f"{op} {fields}: {reply}"
        return reply

    async def error(self, code, op, field=None, **fields):
        reply = await self.ask(op, **fields)
        assert reply["op"] == "error" and reply["code"] == code, f"{op} {fields}: {reply}"
        assert reply["message"] and reply["fatal"] is False, reply
        assert field is None or reply["field"] == field, reply
        return reply

    async def request(self, **fields):
        """(reply, statistics, frame) of a frame.request: they come in this order, and the frame is the reply's."""
        self.passed.clear()
        reply = await self.ok("frame.request", **fields)
        stats = [m for m in self.passed if isinstance(m, dict) and m["op"] == "stats"]
        assert stats and stats[-1]["frame_seq"] == reply["frame_seq"], "statistics come before the ok"
        frame = await self.frame(lambda f: f["frame_seq"] == reply["frame_seq"])
        return reply, stats[-1], frame

    async def upload(self, file, chunk_bytes=100_000):
        """asset.begin, chunks within the credit, asset.end; its reply."""
        offer = await self.ok("asset.begin", sha256=hashlib.sha256(file).hexdigest(), size=len(file))
        at, may = offer["have"], offer["have"] + offer["credit"]
        while at < len(file):
            part = file[at : at + min(chunk_bytes, may - at)]
            if not part:
                credit = await self.text("asset.credit")
                assert credit["asset"] == offer["asset"] and credit["have"] <= at, credit
                may = credit["have"] + credit["credit"]
                continue
            await self.send(chunk(offer["asset"], at, part))
            at += len(part)
        return await self.ask("asset.end", asset=offer["asset"])


class Server:
    """A server of the test's own, on a free port."""

    def __init__(self, program, *options):
        self.log = tempfile.TemporaryFile()
        command = [program, "--port", "0", "--gpu", "software", "--log-level", "error", *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.log, text=True)
        line = self.process.stdout.readline()
        ready = re.fullmatch(r"ready http://127\.0\.0\.1:(\d+)/\n", line)
        assert ready, f"the server did not start: {line}"
        self.port = int(ready[1])

    def stop(self):
        self.process.terminate()
        try:
            return self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()


class Checks:
    """Runs one check after the other; each has a connection of its own, and a sentence."""

    def __init__(self):
        self.failed = 0

    async def check(self, what, body):
        try:
            said = await asyncio.wait_for(body, 4 * PATIENCE_S)
            print(f"ok    {what}" + (f" ({said})" if said else ""), flush=True)
        except Exception as problem:  # the next check tells of something else
            self.failed += 1
            print(f"FAIL  {what}: {type(problem).__name__}: {problem}", flush=True)
