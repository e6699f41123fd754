// A binary frame: the 80-byte header of protocol/README.md, and its payload made into something a canvas can draw.
import { mapToImage } from './spectral_map.js';

export const Encoding = { jpeg: 1, raw: 2, zstd: 3, png: 4 };
const kMimeTypes = { [Encoding.jpeg]: 'image/jpeg', [Encoding.png]: 'image/png' };
const kTargets = { 1: 'composite', 2: 'spectral', 3: 'pass' };
const kBytesPerSample = { 1: 1, 2: 2, 3: 4 };

// Reads the header of one binary message; throws a RangeError with a sentence when it is not a frame.
export function parseFrame(buffer) {
    const view = new DataView(buffer);
    if (buffer.byteLength < 80 || view.getUint8(0) !== 1) throw new RangeError('a binary message is not a frame');
    const headerLength = view.getUint16(2, true);
    const payloadLength = view.getUint32(68, true);
    if (headerLength < 80 || headerLength % 8 || headerLength + payloadLength !== buffer.byteLength) {
        throw new RangeError('a frame lies about its length');
    }
    return {
        seq: view.getUint32(4, true),
        epoch: view.getUint16(10, true),
        target: kTargets[view.getUint8(12)],
        encoding: view.getUint8(13),
        sample: view.getUint8(14),
        planar: view.getUint8(15) === 1,
        shuffled: view.getUint8(15) > 1,
        flags: view.getUint32(16, true),
        width: view.getUint16(20, true),
        height: view.getUint16(22, true),
        viewWidth: view.getUint16(24, true),
        viewHeight: view.getUint16(26, true),
        bands: view.getUint16(28, true),
        jpegQuality: view.getUint8(30),
        level: view.getUint8(31),
        inputSeq: view.getUint32(32, true),
        stateRev: view.getUint32(36, true),
        clientUs: Number(view.getBigUint64(40, true)),
        serverUs: Number(view.getBigUint64(48, true)),
        holdUs: view.getUint32(56, true),
        renderUs: view.getUint32(60, true),
        encodeUs: view.getUint32(64, true),
        scale: view.getFloat32(76, true),
        payload: new Uint8Array(buffer, headerLength, payloadLength),
    };
}

// The frame's payload as the browser's own picture format, or null when it is not one.
export function frameBlob(frame) {
    const type = kMimeTypes[frame.encoding];
    return type ? new Blob([frame.payload], { type }) : null;
}

// Something drawImage takes. Throws when the payload is not what the header says.
export async function decodeFrame(frame, look) {
    const blob = frameBlob(frame);
    if (blob) return createImageBitmap(blob);
    if (frame.encoding !== Encoding.raw || frame.shuffled) throw new RangeError('a frame has an encoding this page cannot read');
    const expected = frame.width * frame.height * frame.bands * kBytesPerSample[frame.sample];
    if (frame.payload.byteLength !== expected) throw new RangeError('a raw frame has the wrong size');
    return createImageBitmap(mapToImage(frame, look));
}
