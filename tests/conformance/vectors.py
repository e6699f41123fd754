#!/usr/bin/python3
"""The vectors of protocol/vectors against a live server: vectors.py FOLDER (SERVER-PROGRAM | PORT)

Of the texts and headers those with a `reply`; all of the connections.
"""
import asyncio
import json
import pathlib
import sys

from wire import Checks, Client, Closed, Frame, Server

QUIET_S = 0.5


def matches(message, wanted):
    return isinstance(message, dict) and all(field in message and message[field] == value for field, value in wanted.items())


async def say(client, what):
    times = what.get("times", 1)
    if "repeat" in what:
        await client.send(what["repeat"] * times)
    elif "binary_hex" in what or "binary_repeat" in what:
        await client.send(bytes.fromhex(what.get("binary_hex", "")) + bytes.fromhex(what.get("binary_repeat", "")) * times)
    elif "text_hex" in what:  # a text frame that a library would not send
        await client.socket.write_frame(True, 1, bytes.fromhex(what["text_hex"]))
    else:
        for _ in range(times):
            await client.send(what["text"])


async def step(client, what):
    if "send" in what:
        try:
            await say(client, what["send"])
        except Exception:  # closed while we spoke: the next step looks at how
            pass
    elif "expect" in what:
        await client.until(lambda m: matches(m, what["expect"]), what["expect"])
    elif "expect_frame" in what:
        client.last = await client.until(
            lambda m: isinstance(m, Frame) and all(m[f] == v for f, v in what["expect_frame"].items()), what["expect_frame"]
        )
    elif "ack" in what:
        await client.ack(client.last)
    elif "expect_close" in what:
        try:
            while True:
                assert await client.receive() is not None, "the connection stays"
        except Closed as closed:
            assert closed.code == what["expect_close"], closed
    else:
        raise AssertionError(f"a step that this runner does not know: {what}")


async def connection(port, steps):
    client = await Client.connect(port)
    try:
        for what in steps:
            await step(client, what)
    finally:
        await client.close()


async def answer(port, vector, message):
    """Said after a hello; the reply is the vector's, and the connection is as alive as it says."""
    client = await Client.connect(port)
    try:
        await client.hello()
        if "close" in vector:
            await step(client, {"send": message})
            return await step(client, {"expect_close": vector["close"]})
        await say(client, message)
        if vector["reply"] is not None:
            reply = await client.receive()
            assert matches(reply, vector["reply"]), f"{reply}, and not {vector['reply']}"
        await client.send({"op": "ping", "t_us": 4711})
        await client.until(lambda m: matches(m, {"op": "pong", "t_us": 4711}), "a pong", 20)
        assert not [m for m in client.passed if isinstance(m, dict) and m["op"] == "error"], client.passed
    finally:
        await client.close()


async def run(folder, port):
    checks = Checks()
    for file in ("client_messages", "binary_headers"):
        for vector in json.loads((folder / f"{file}.json").read_text())["vectors"]:
            if "reply" not in vector and "close" not in vector:
                continue
            if file == "binary_headers":
                message = {"binary_hex": vector["hex"]}
            elif "hex" in vector:
                message = {"text_hex": vector["hex"]}
            else:
                message = {"text": vector["text"]}
            await checks.check(f"{file}: {vector['name']}", answer(port, vector, message))
    for vector in json.loads((folder / "connections.json").read_text())["vectors"]:
        await checks.check(f"connections: {vector['name']}", connection(port, vector["steps"]))
    return checks.failed


def main():
    folder, target = pathlib.Path(sys.argv[1]), sys.argv[2]
    if target.isdigit():
        sys.exit(1 if asyncio.run(run(folder, int(target))) else 0)
    server = Server(target)
    try:
        failed = asyncio.run(run(folder, server.port))
    finally:
        code = server.stop()
    print(f"{failed} vectors failed" if failed else "all vectors hold")
    sys.exit(1 if failed or code != 0 else 0)


if __name__ == "__main__":
    main()
