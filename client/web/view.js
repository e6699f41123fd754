// The picture: decodes frames, paints the newest once per animation frame, and acknowledges what was painted.
import { decodeFrame } from './frame.js';
import { FrameAge } from './frame_age.js';

const kRateWindowMs = 1000;
const kLatencySamples = 30;

export class View {
    // ack({seq, recv_us, decode_us, paint_us}); failed(error) for a frame that cannot be shown; painted(frame).
    constructor(canvas, { ack, failed, painted }) {
        this.canvas_ = canvas;
        this.context_ = canvas.getContext('2d', { alpha: false });
        this.report_ = { ack, failed, painted };
        this.look = { band: -1 };
        this.latenciesMs_ = [];
        this.paintedMs_ = [];
        this.age = new FrameAge();
        this.measuredInput_ = 0;
        this.reset();
    }

    // A new connection counts its frames from 1 again, and inputs on.
    reset() {
        this.newestSeq_ = 0;
        this.waiting_ = null;
        this.age.reset();
        ++this.generation_;
    }

    generation_ = 0;

    async show(frame, recvUs) {
        const generation = this.generation_;
        let image;
        try {
            image = await decodeFrame(frame, this.look);
        } catch (error) {
            this.report_.failed(error);
            this.report_.ack({ seq: frame.seq, recv_us: recvUs, decode_us: 0, paint_us: 0 });
            return;
        }
        const decodedUs = performance.now() * 1000;
        if (generation !== this.generation_ || frame.seq <= this.newestSeq_) {
            image.close();
            return;
        }
        this.newestSeq_ = frame.seq;
        this.waiting_?.image.close();
        this.waiting_ = { frame, image, recvUs, decodedUs };
    }

    // Once per animation frame.
    paint() {
        if (!this.waiting_) return;
        const { frame, image, recvUs, decodedUs } = this.waiting_;
        this.waiting_ = null;
        if (this.canvas_.width !== frame.viewWidth || this.canvas_.height !== frame.viewHeight) {
            this.canvas_.width = frame.viewWidth;
            this.canvas_.height = frame.viewHeight;
        }
        this.context_.drawImage(image, 0, 0, frame.viewWidth, frame.viewHeight);
        image.close();

        const nowMs = performance.now();
        this.report_.ack({
            seq: frame.seq, recv_us: recvUs, decode_us: Math.max(0, Math.round(decodedUs - recvUs)),
            paint_us: Math.max(0, Math.round(nowMs * 1000 - decodedUs)),
        });
        this.paintedMs_.push(nowMs);
        if (frame.inputSeq > this.measuredInput_) {
            this.measuredInput_ = frame.inputSeq;
            this.latenciesMs_.push(nowMs - frame.clientUs / 1000);
            if (this.latenciesMs_.length > kLatencySamples) this.latenciesMs_.shift();
        }
        this.age.painted(frame, nowMs * 1000);
        this.report_.painted({ ...frame, decodeMs: (decodedUs - recvUs) / 1000 });
    }

    // Frames painted in the last second; 0 when the picture rests.
    framesPerSecond() {
        const since = performance.now() - kRateWindowMs;
        this.paintedMs_ = this.paintedMs_.filter((ms) => ms > since);
        return this.paintedMs_.length;
    }

    // Median time from an input to the picture that shows it, ms; null before the first.
    latencyMs() {
        const sorted = [...this.latenciesMs_].sort((a, b) => a - b);
        return sorted.length ? sorted[sorted.length >> 1] : null;
    }
}
