// A GLB on its way to the server: announced by its digest, sent in checked chunks as far as the server gives credit.
import { crc32, sha256Hex } from './checksums.js';

const kChunkHeaderBytes = 24;

export class Upload {
    constructor(connection, limits) {
        this.connection_ = connection;
        this.limits_ = limits;
        this.asset_ = null;
    }

    // Resolves to the asset.end reply, which names the digest; rejects with {message}. progress(0..1) on the way.
    async run(bytes, progress) {
        const most = this.limits_?.asset_bytes ?? 64 * 2 ** 20;
        if (bytes.length === 0) throw { message: 'The file is empty.' };
        if (bytes.length > most) throw { message: `The file is larger than the ${Math.floor(most / 2 ** 20)} MiB this server takes.` };
        const sha256 = await sha256Hex(bytes);
        const offer = await this.connection_.request('asset.begin', { sha256, size: bytes.length, mime: 'model/gltf-binary' });
        this.asset_ = offer.asset;
        this.credit_ = offer;
        let offset = offer.have;
        while (offset < bytes.length) {
            if (this.stopped_) throw this.stopped_;
            const allowed = this.credit_.have + this.credit_.credit - offset;
            const size = Math.min(this.limits_?.chunk_bytes ?? 256 * 1024, bytes.length - offset, allowed);
            if (size <= 0) {
                await this.moreCredit_();
                continue;
            }
            this.sendChunk_(bytes.subarray(offset, offset + size), offset);
            offset += size;
            progress(this.credit_.have / bytes.length);
        }
        if (this.stopped_) throw this.stopped_;
        progress(1);
        return { sha256, ...(await this.connection_.request('asset.end', { asset: this.asset_ })) };
    }

    sendChunk_(payload, offset) {
        const message = new Uint8Array(kChunkHeaderBytes + payload.length);
        const view = new DataView(message.buffer);
        view.setUint8(0, 2);
        view.setUint8(1, 1);
        view.setUint16(2, kChunkHeaderBytes, true);
        view.setUint32(4, this.asset_, true);
        view.setBigUint64(8, BigInt(offset), true);
        view.setUint32(16, payload.length, true);
        view.setUint32(20, crc32(payload), true);
        message.set(payload, kChunkHeaderBytes);
        this.connection_.sendBinary(message.buffer);
    }

    moreCredit_() {
        return new Promise((resolve, reject) => (this.waiting_ = { resolve, reject }));
    }

    // From the server's asset.credit.
    credit(message) {
        if (message.asset !== this.asset_) return;
        this.credit_ = message;
        this.waiting_?.resolve();
        this.waiting_ = null;
    }

    // The user or a lost connection (code "lost") ends it.
    stop(message, code) {
        this.stopped_ = { message, code };
        if (this.asset_ !== null) this.connection_.send({ op: 'asset.abort', asset: this.asset_ });
        this.waiting_?.reject(this.stopped_);
        this.waiting_ = null;
    }
}
