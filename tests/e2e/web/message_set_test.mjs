// The whole message set of caustream.v1 from a browser's own WebSocket, without the page's code: every op that
// protocol/README.md lists, both ways, and a frame of each encoding that a browser can look into.
// usage: node message_set_test.mjs PATH_OF_CAUSTREAM_SERVER SCENE.glb, of more than half the credit and less than all of it
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { startServer } from './server.mjs';
import { openViewer } from './viewer.mjs';

const [program, glbPath] = process.argv.slice(2);
const glb = await readFile(glbPath);
const logs = await mkdtemp(join(tmpdir(), 'caustream-'));
const server = await startServer(program, 0, ['--record-dir', logs]);
const viewer = await openViewer(server.url);    // whose origin the server lets in

// In the browser: says everything there is to say and returns what came back.
async function sayEverything({ file, sha256 }) {
    const bytes = Uint8Array.from(atob(file), (letter) => letter.charCodeAt(0));
    const socket = new WebSocket(`${location.origin.replace('http', 'ws')}/ws`, 'caustream.v1');
    socket.binaryType = 'arraybuffer';
    const ops = {}, frames = [], replies = new Map(), waiting = [];
    const seen = (test) => new Promise((resolve) => waiting.push({ test, resolve }));
    socket.onmessage = ({ data }) => {
        const message = typeof data === 'string' ? JSON.parse(data) : { op: 'FRAME', data };
        (ops[message.op] ??= []).push(message.op === 'FRAME' ? null : message);
        if (message.op === 'FRAME') {
            const view = new DataView(data);
            const frame = { seq: view.getUint32(4, true), encoding: view.getUint8(13), flags: view.getUint32(16, true), width: view.getUint16(20, true), payload: new Uint8Array(data, view.getUint16(2, true)) };
            frames.push(frame);
            send({ op: 'ack', seq: frame.seq, recv_us: 1, decode_us: 1, paint_us: 1 });
        }
        if (message.id !== undefined) replies.get(message.id)?.(message);
        for (const one of waiting.splice(0)) one.test(message) ? one.resolve(message) : waiting.push(one);
    };
    const closed = new Promise((resolve) => (socket.onclose = ({ code }) => resolve(code)));
    await new Promise((resolve, reject) => Object.assign(socket, { onopen: resolve, onerror: reject }));
    const send = (message) => socket.send(JSON.stringify(message));
    let nextId = 1;
    const ask = (op, fields = {}) => new Promise((resolve) => {
        const id = nextId++;
        replies.set(id, resolve);
        send({ op, id, ...fields });
    });
    const picture = async (fields) => {
        const frame = seen((message) => message.op === 'FRAME');
        const reply = await ask('frame.request', fields);
        await frame;
        return { reply, frame: frames.at(-1) };
    };
    const chunk = (asset, offset, payload) => {
        let crc = ~0;
        for (const byte of payload) {
            crc ^= byte;
            for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
        }
        const message = new DataView(new ArrayBuffer(24 + payload.length));
        message.setUint8(0, 2), message.setUint8(1, 1), message.setUint16(2, 24, true), message.setUint32(4, asset, true);
        message.setBigUint64(8, BigInt(offset), true), message.setUint32(16, payload.length, true), message.setUint32(20, ~crc >>> 0, true);
        new Uint8Array(message.buffer).set(payload, 24);
        socket.send(message.buffer);
    };

    const state = seen((message) => message.op === 'state');
    const welcome = await ask('hello', { client: { name: 'browser', version: '1' }, caps: ['jpeg', 'png', 'raw', 'f32'], max_inflight: 4 });
    await state;
    const small = { transport: { mode: 'refined', photon_grid: 64, map_size: 64 }, stream: { width: 96, height: 64, quality: ['fixed', 90] } };
    const updated = await ask('update', { patch: small });
    const recording = await ask('record', { on: true });
    const stills = [];
    for (const encoding of ['jpeg', 'png', 'raw']) {
        await ask('update', { patch: { stream: { encoding } } });
        stills.push(await picture({ still: true }));
    }
    await ask('update', { patch: { stream: { encoding: 'jpeg' } } });
    const streamed = seen((message) => message.op === 'FRAME');
    const started = await ask('stream.start', { stats: true });
    await streamed;
    const paused = await ask('stream.pause'), resumed = await ask('stream.resume');
    const moved = seen((message) => message.op === 'FRAME');
    send({ op: 'input', seq: 1, t_us: 5, camera: { fov_y_deg: 31 } });
    await moved;
    const pong = seen((message) => message.op === 'pong');
    send({ op: 'ping', t_us: 77 });
    await pong;

    const aborted = await ask('asset.begin', { sha256: 'a'.repeat(64), size: 9 });
    send({ op: 'asset.abort', asset: aborted.asset });
    const offer = await ask('asset.begin', { sha256, size: bytes.length });
    for (let at = offer.have; at < bytes.length; at += 65536) chunk(offer.asset, at, bytes.subarray(at, at + 65536));
    const uploaded = await ask('asset.end', { asset: offer.asset });
    const ofTheFile = seen((message) => message.op === 'state');
    const shown = await ask('update', { patch: { scene: ['asset', sha256], lights: null, materials: null, camera: null } });
    await ofTheFile;
    const refused = await ask('update', { patch: { camera: { fov_y_deg: 900 } } });
    const stopped = await ask('record', { on: false });
    globalThis.finished = { closed, ops };
    return { welcome, updated, recording, started, paused, resumed, uploaded, shown, refused, stopped, ops: Object.keys(ops),
        stills: stills.map(({ reply, frame }) => ({ reply, encoding: frame.encoding, flags: frame.flags, width: frame.width, head: [...frame.payload.slice(0, 4)], bytes: frame.payload.length })),
    };
}

try {
    const sha256 = createHash('sha256').update(glb).digest('hex');
    const said = await viewer.page.evaluate(sayEverything, { file: glb.toString('base64'), sha256 });
    assert.equal(said.welcome.op, 'welcome');
    assert.equal(said.welcome.protocol, 'caustream.v1');
    for (const what of ['updated', 'recording', 'started', 'paused', 'resumed', 'uploaded', 'shown', 'stopped']) assert.equal(said[what].op, 'ok', `${what}: ${JSON.stringify(said[what])}`);
    assert.match(said.recording.recording, /\.jsonl$/);
    assert.equal(said.uploaded.sha256, sha256);
    assert.deepEqual([said.refused.op, said.refused.code, said.refused.field], ['error', 'out_of_range', 'camera.fov_y_deg']);
    assert.deepEqual(said.stills.map(({ encoding }) => encoding), [1, 4, 2], 'jpeg, png, raw');
    assert.deepEqual(said.stills[0].head.slice(0, 2), [0xff, 0xd8]);
    assert.deepEqual(said.stills[1].head, [0x89, 0x50, 0x4e, 0x47]);
    assert.equal(said.stills[2].bytes, 96 * 64 * 3);
    for (const { reply, flags, width } of said.stills) {
        assert.match(reply.map_hash, /^[0-9a-f]{16}$/);
        assert.equal(flags & 1, 1);
        assert.equal(width, 96);
    }
    const ended = viewer.page.evaluate(async () => [await globalThis.finished.closed, Object.keys(globalThis.finished.ops), globalThis.finished.ops.goaway?.[0]]);
    server.stop();
    const [code, ops, goaway] = await ended;
    assert.equal(code, 1001);
    assert.equal(goaway.reason, 'drain');
    for (const op of ['welcome', 'ok', 'error', 'state', 'stream.info', 'asset.credit', 'pong', 'stats', 'goaway', 'FRAME']) assert(ops.includes(op), `no ${op} came`);
    console.log(`ok    every message, both ways: ${ops.join(' ')}`);
} finally {
    await viewer.browser.close();
    await rm(logs, { recursive: true, force: true });
}
process.exit(0);
