#!/usr/bin/python3
"""The whole message set of caustream.v1, both ways, by a client that shares no code with the project:
conformance.py SERVER-PROGRAM FILE.glb
"""
import asyncio
import hashlib
import pathlib
import subprocess
import sys
import tempfile
import urllib.error
import urllib.request

import websockets

from wire import CONVERGED, JPEG, PNG, RAW, STILL, Checks, Client, Closed, Frame, Server, chunk, png_samples

SMALL = {
    "transport": {"mode": "refined", "photon_grid": 64, "map_size": 64},
    "stream": {"width": 96, "height": 64, "max_fps": 240},
}
TOKEN = "a token of more than sixteen characters"


def light(x):
    return {"key": {"position": [x, 4.0, 0.5], "direction": [-x, -4.0, -0.5]}}


async def viewer(port, **extra):
    client = await Client.connect(port)
    await client.hello(**extra)
    return client


async def small(port, **extra):
    client = await viewer(port, **extra)
    await client.ok("update", patch=SMALL)
    return client


async def closing(client, code):
    """Reads until the server closes; the messages on the way."""
    messages = []
    try:
        while (message := await client.receive()) is not None:
            messages.append(message)
    except Closed as closed:
        assert closed.code == code, closed
        return messages
    raise AssertionError(f"not closed with {code}; {messages[-3:]}")


# What there is


async def handshake(port):
    for protocols in (None, ["caustream.v9"]):
        try:
            socket = await websockets.connect(f"ws://127.0.0.1:{port}/ws", subprotocols=protocols)
            await socket.close()
            raise AssertionError(f"taken with the subprotocols {protocols}")
        except (websockets.InvalidStatusCode, websockets.InvalidHandshake):
            pass
    client = await Client.connect(port, "?srv=somebody")
    await client.hello()
    await client.close()


async def pages(port):
    for path, part in (("/livez", b""), ("/healthz", b""), ("/readyz", b""), ("/metrics", b"# TYPE "), ("/", b"<html")):
        with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}") as answer:
            assert answer.status == 200 and part in answer.read(), path
    try:
        urllib.request.urlopen(f"http://127.0.0.1:{port}/nothing")
        raise AssertionError("a page that is not there is")
    except urllib.error.HTTPError as error:
        assert error.code == 404, error.code


async def welcome_is_whole(port):
    client = await viewer(port)
    welcome, state = client.welcome, client.state
    kinds = {
        "session": str, "server": str, "build": str, "gpu": str, "resumed": bool, "rev": int, "state": dict, "caps": list,
        "scenes": list, "passes": list, "limits": dict, "glasses": list, "missing_assets": list, "heartbeat_s": int,
    }
    for field, kind in kinds.items():
        assert isinstance(welcome[field], kind), (field, welcome[field])
    assert welcome["protocol"] == "caustream.v1" and "gem" in welcome["scenes"]
    assert all(isinstance(value, int) for value in welcome["limits"].values())
    assert state["scene"]["name"] and state["scene"]["triangles"] > 0 and state["state"]["camera"]["eye"]
    for light_there in state["scene"]["lights"]:
        assert state["state"]["lights"][light_there["name"]]["type"] == light_there["type"]
    await client.send({"op": "ping", "t_us": 123})
    pong = await client.text("pong")
    assert pong["t_us"] == 123 and pong["server_us"] > 0
    await client.close()
    return ", ".join(welcome["caps"])


# The document


async def updates(port):
    client = await viewer(port)
    before = await client.ok("update", patch=SMALL)
    after = await client.ok("update", patch={"camera": {"fov_y_deg": 33}})
    assert after["rev"] > before["rev"], (before, after)
    await client.error("out_of_range", "update", field="camera.fov_y_deg", patch={"camera": {"fov_y_deg": 500}, "outside_index": 1.2})
    await client.ok("update", patch={"scene": ["builtin", "prism"], "camera": None})
    state = await client.text("state")
    assert state["scene"]["name"] and state["state"]["camera"]["fov_y_deg"] != 33, "null brings the file's value back"
    assert state["state"]["outside_index"] == 1.0, "the refused update left nothing behind"
    for name, material in state["state"]["materials"].items():
        if "dispersion" in material:
            await client.ok("update", patch={"materials": {name: {"dispersion": ["cauchy", 1.5, 0.004], "absorption": [[400, 700], [0.5, 0.1]]}}})
    await client.error("bad_request", "update", patch={"lights": {"nobody": {"type": "point"}}})
    await client.close()


async def encodings(port):
    client = await small(port)
    _, stats, jpeg = await client.request()
    assert jpeg["encoding"] == JPEG and jpeg.payload[:2] == b"\xff\xd8" and jpeg["target"] == 1 and jpeg["jpeg_quality"] > 0
    assert stats["photons"] > 0 and all(isinstance(p["run"], bool) and p["reason"] for p in stats["plan"]), stats
    await client.ok("update", patch={"stream": {"encoding": "png"}})
    reply, _, png = await client.request(still=True)
    assert png["encoding"] == PNG and png["flags"] & STILL and len(reply["map_hash"]) == 16
    await client.ok("update", patch={"stream": {"encoding": "raw"}})
    again, _, raw = await client.request(still=True)
    assert raw["encoding"] == RAW and len(raw.payload) == 96 * 64 * 3 == raw["raw_len"]
    assert again["map_hash"] == reply["map_hash"], "the same state gives the same map"
    assert png_samples(png.payload) == raw.payload, "PNG and raw are the same bits"
    for sample, size in (("f16", 2), ("f32", 4)):
        await client.ok("update", patch={"transport": {"wavelengths": 5}, "stream": {"target": "spectral", "sample": sample, "bands": "wavelengths"}})
        client.passed.clear()
        number = await client.ok("frame.request")
        info = [m for m in client.passed if isinstance(m, dict) and m["op"] == "stream.info"][-1]
        frame = await client.frame(lambda f: f["frame_seq"] == number["frame_seq"])
        assert (info["target"], info["sample"], info["bands"], info["unit"]) == ("spectral", sample, 5, "concentration"), info
        assert len(info["wavelengths_nm"]) == 5 and len(info["light_matrix"]) == 16 and info["epoch"] == frame["epoch"]
        assert frame["target"] == 2 and frame["bands"] == 5 and len(frame.payload) == 64 * 64 * 5 * size and frame["scale"] > 0
    await client.ok("update", patch={"stream": {"target": "camera_casters", "encoding": "jpeg", "sample": "u8", "bands": "rgb"}})
    assert (await client.request())[2]["target"] == 3
    await client.close()


async def glbs(port, glb):
    client = await small(port)
    name = hashlib.sha256(glb).hexdigest()
    report = await client.upload(glb, 3000)
    assert report["op"] == "ok" and report["sha256"] == name and report["triangles"] > 0 and report["meshes"] > 0, report
    await client.ok("update", patch={"scene": ["asset", name], "lights": None, "materials": None, "camera": None})
    assert (await client.text("state"))["state"]["scene"] == ["asset", name]
    await client.request()
    other = await viewer(port)
    offer = await other.ok("asset.begin", sha256=name, size=len(glb), mime="model/gltf-binary")
    assert offer["have"] == len(glb), "the server has it already"
    await other.ok("asset.end", asset=offer["asset"])
    # What is refused, and that the upload goes on
    offer = await client.ok("asset.begin", sha256="b" * 64, size=10)
    await client.error("busy", "asset.begin", sha256="c" * 64, size=10)
    await client.send(chunk(offer["asset"], 3, b"hello"))
    assert (await client.text("error"))["code"] == "bad_offset"
    await client.send(chunk(offer["asset"], 0, b"hello", 1))
    assert (await client.text("error"))["code"] == "asset_invalid"
    await client.send(chunk(offer["asset"], 0, b"hello"))
    await client.error("asset_invalid", "asset.end", field="size", asset=offer["asset"])
    again = await client.ok("asset.begin", sha256="b" * 64, size=10)
    await client.send({"op": "asset.abort", "asset": again["asset"]})
    assert (await client.upload(b"this is no GLB"))["code"] == "asset_invalid"
    await client.error("asset_missing", "update", patch={"scene": ["asset", "d" * 64]})
    await client.error("too_large", "asset.begin", field="size", sha256="e" * 64, size=1 << 40)
    await client.close()
    await other.close()


# Frames


async def the_window(port):
    """Without an acknowledgement no more frames come than the window holds; with one, they go on."""
    client = await small(port, max_inflight=2)
    await client.ok("stream.start", stats=True)
    got, seq = [], 0
    for _ in range(12):
        seq += 1
        await client.send({"op": "input", "seq": seq, "t_us": seq, "lights": light(0.1 + 0.01 * seq)})
        message = await client.receive(0.3)
        while message is not None:
            if isinstance(message, Frame) and not message["flags"] & STILL:
                got.append(message)
            message = await client.receive(0.05)
    assert 1 <= len(got) <= 2, f"{len(got)} frames with a window of 2"
    await client.ack(got[-1])
    newest = await client.frame(lambda f: f["input_seq"] == seq)
    assert newest["client_us"] == seq and newest["frame_seq"] > got[-1]["frame_seq"]
    stats = await client.text("stats", 20)
    assert stats["window"] == 2 and stats["render_ms"] > 0
    await client.ok("stream.pause")
    await client.send({"op": "input", "seq": seq + 1, "t_us": 1, "lights": light(0.9)})
    await asyncio.sleep(0.5)
    await client.ok("stream.resume")
    await client.frame(lambda f: f["input_seq"] == seq + 1)
    await client.close()
    return f"{len(got)} frames unacknowledged"


async def rest(port):
    """A picture that rests ends with a STILL; a traced one with CONVERGED, as a PNG where the client reads it."""
    client = await small(port)
    await client.ok("stream.start", stats=True)
    await client.frame(lambda f: f["flags"] & STILL)
    await client.ok("update", patch={"transport": {"mode": "traced", "target_error": 0.5}})
    last = await client.frame(lambda f: f["flags"] & CONVERGED)
    assert last["flags"] & STILL and last["encoding"] == PNG, last.header
    told = [m["convergence"] for m in client.passed if isinstance(m, dict) and m["op"] == "stats" and "convergence" in m]
    told = told or [(await client.text("stats", 10))["convergence"]]
    assert all(0 <= c["progress"] <= 1 and c["target"] == 0.5 for c in told), told
    await client.request(converge=True)
    await client.close()


# Sessions


async def resumed(port):
    client = await viewer(port)
    session, caps = client.welcome["session"], client.welcome["caps"]
    await client.ok("update", patch={**SMALL, "scene": ["builtin", "prism"]})
    await client.close()
    # Whatever a server remembers, the client's own document counts.
    again = await viewer(port, resume={"session": session, "state": {"scene": ["builtin", "sphere"], "outside_index": 1.25}, "rev": 2, "input_seq": 0})
    assert again.welcome["state"]["outside_index"] == 1.25 and again.welcome["state"]["scene"] == ["builtin", "sphere"]
    missing = await viewer(port, resume={"session": "never-heard-of", "state": {"scene": ["asset", "f" * 64]}})
    assert missing.welcome["missing_assets"] == ["f" * 64] and missing.welcome["resumed"] is False
    await missing.close()
    if "resume" not in caps:
        await again.close()
        return "the document; sessions are not kept here"
    assert again.welcome["resumed"] is True and again.welcome["session"] == session
    # Without a document of its own, the server's; and who still holds the session is told.
    taker = await viewer(port, resume={"session": session})
    assert taker.welcome["resumed"] is True and taker.welcome["state"]["outside_index"] == 1.25
    goodbye = await closing(again, 4409)
    assert any(isinstance(m, dict) and m["op"] == "goaway" and m["reason"] == "takeover" for m in goodbye), goodbye
    await taker.close()
    return "sessions are kept, and taken over"


async def followed(port):
    owner = await small(port)
    if "follow" not in owner.welcome["caps"]:
        client = await Client.connect(port)
        await client.error("unsupported", "hello", client={"name": "c", "version": "1"}, role="view", follow=owner.welcome["session"])
        await client.close()
        return "not offered"
    watcher = await viewer(port, role="view", follow=owner.welcome["session"])
    await watcher.ok("update", patch={"stream": {"width": 96, "height": 64, "encoding": "raw"}, "camera": {"fov_y_deg": 41}})
    await watcher.error("forbidden", "update", patch={"lights": light(0.5)})
    await owner.ok("update", patch={"stream": {"encoding": "raw"}, "camera": {"fov_y_deg": 41}, "lights": light(0.3)})
    (hash_a, _, a), (hash_b, _, b) = await owner.request(still=True), await watcher.request(still=True)
    assert hash_a["map_hash"] == hash_b["map_hash"] and a.payload == b.payload, "one light, one camera, one picture"
    await watcher.ok("stream.start")
    await watcher.frame()
    await owner.send({"op": "input", "seq": 1, "t_us": 1, "lights": light(0.7)})
    await watcher.text("state", 20)
    await owner.close()
    status = await watcher.text("status", 20)
    assert status["key"] == "follow" and status["message"], status
    await watcher.close()
    return "its own camera, the other's light"


async def recorded(port, folder):
    client = await small(port)
    if "record" not in client.welcome["caps"]:
        await client.error("unsupported", "record", on=True)
        await client.close()
        return "not offered"
    started = await client.ok("record", on=True)
    await client.ok("update", patch={"camera": {"fov_y_deg": 44}})
    await client.request()
    await client.ok("record", on=False)
    await client.close()
    log = pathlib.Path(folder) / started["recording"]
    assert log.exists() and log.stat().st_size > 0, f"no {log}"
    return started["recording"]


async def roles_and_windows(port):
    client = await Client.connect(port)
    about = {"name": "c", "version": "1"}
    await client.error("out_of_range", "hello", field="max_inflight", client=about, max_inflight=9)
    await client.error("unsupported", "hello", field="role", client=about, role="emperor")
    await client.error("unknown_field", "hello", field="mood", client=about, strict=True, mood="good")
    await client.hello(strict=True, max_inflight=8)
    await client.error("unknown_field", "update", field="colour", patch={"colour": "blue"})
    await client.error("unknown_op", "dance", field="op")
    await client.error("bad_request", "update", field="patch")
    await client.close()


async def the_full_house(port):
    limit = (await viewer(port)).welcome["limits"]["sessions"]
    clients = []
    try:
        while len(clients) < limit + 8:
            client = await Client.connect(port)
            await client.send({"op": "hello", "id": 1, "client": {"name": "c", "version": "1"}})
            reply = await client.until(lambda m: isinstance(m, dict) and m.get("id") == 1, "a reply")
            clients.append(client)
            if reply["op"] == "error":
                assert reply["code"] == "busy" and reply["fatal"] and reply["retry_ms"] > 0, reply
                await closing(client, 4429)
                return f"the limit is {limit}"
        raise AssertionError("no limit was met")
    finally:
        for client in clients:
            await client.close()


async def tokens(program):
    with tempfile.NamedTemporaryFile("w") as file:
        file.write(TOKEN + "\n")
        file.flush()
        server = Server(program, "--token-file", file.name)
        try:
            for wrong in ({}, {"token": "wrong"}):
                client = await Client.connect(server.port)
                await client.send({"op": "hello", "id": 1, "client": {"name": "c", "version": "1"}, **wrong})
                refused = [m for m in await closing(client, 4401) if m["op"] == "error"]
                assert refused and refused[0]["code"] == "auth_required" and refused[0]["fatal"], refused
            client = await viewer(server.port, token=TOKEN)
            await client.close()
        finally:
            server.stop()


async def goodbye(server):
    """SIGTERM: goaway, then 1001."""
    client = await viewer(server.port)
    server.process.terminate()
    said = await closing(client, 1001)
    away = [m for m in said if isinstance(m, dict) and m["op"] == "goaway"]
    assert away and away[0]["reason"] in ("drain", "shutdown") and away[0]["reconnect_ms"] >= 0, said
    assert await asyncio.get_running_loop().run_in_executor(None, server.process.wait, 30) == 0
    return away[0]["reason"]


async def run(program, glb):
    checks, seen = Checks(), tempfile.TemporaryDirectory()
    options = ["--record-dir", seen.name] if "--record-dir" in subprocess.run([program, "--help"], capture_output=True, text=True).stdout else []
    server = Server(program, *options)
    port = server.port
    try:
        await checks.check("the handshake wants the subprotocol", handshake(port))
        await checks.check("pages beside the WebSocket", pages(port))
        await checks.check("hello, welcome, state, ping, pong", welcome_is_whole(port))
        await checks.check("hello's choices, strictness, unknown ops", roles_and_windows(port))
        await checks.check("update: whole or not at all, null, scenes, materials", updates(port))
        await checks.check("frames as JPEG, PNG, raw, f16, f32, a pass", encodings(port))
        await checks.check("uploads: credit, offsets, checksums, hashes, abort", glbs(port, glb))
        await checks.check("input, ack, window, stream.start, pause, resume, stats", the_window(port))
        await checks.check("STILL and CONVERGED at rest", rest(port))
        await checks.check("resume, takeover, missing assets", resumed(port))
        await checks.check("role view", followed(port))
        await checks.check("record", recorded(port, seen.name))
        await checks.check("busy when all sessions are taken", the_full_house(port))
        await checks.check("a token", tokens(program))
        await checks.check("goaway and 1001 at the end", goodbye(server))
    finally:
        server.stop()
    return checks.failed


def main():
    failed = asyncio.run(run(sys.argv[1], pathlib.Path(sys.argv[2]).read_bytes()))
    print(f"{failed} checks failed" if failed else "all checks passed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
