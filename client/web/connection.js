// The socket: hello, numbered requests and their replies, pings, and coming back after a loss. Knows no pictures.

import { Backoff, closingOf, comeBackMs } from './retry.js';

const kSubprotocol = 'caustream.v1';
const kPingEveryMs = 1000;
const kSilenceMs = 12000;        // no pong for this long: the server is frozen or the way to it is gone
const kAuthRequired = 4401;

export class Connection {
    // handlers: {<op>(message) of every op but ok, error and pong; frame(buffer, recvUs); hello() -> its fields;
    // forget() the session that hello offered to resume; refused(error) for errors that answer no request; link(state,
    // why, waitMs) with state "open", "retry", "ended" or "auth"; roundTrip(sentUs, serverUs, receivedUs)}
    constructor(url, handlers) {
        this.url_ = url;
        this.handlers_ = handlers;
        this.requests_ = new Map();
        this.lastId_ = 0;
        this.backoff_ = new Backoff();
        this.ready = false;
        addEventListener('online', () => this.retryTimer_ && this.connect());
    }

    connect() {
        clearTimeout(this.retryTimer_);
        this.retryTimer_ = null;
        clearInterval(this.pingTimer_);
        this.socket_?.close();
        const socket = new WebSocket(this.url_, kSubprotocol);
        socket.binaryType = 'arraybuffer';
        this.socket_ = socket;
        this.comeBackMs_ = null;
        this.refusal_ = null;
        this.heardMs_ = performance.now();
        socket.onopen = () => {
            this.pingTimer_ = setInterval(() => this.ping_(), kPingEveryMs);
            this.hello_();
        };
        socket.onmessage = (event) => socket === this.socket_ && this.receive_(event.data);
        socket.onclose = (event) => socket === this.socket_ && this.lost_(event.code);
    }

    send(message) {
        if (this.socket_?.readyState === WebSocket.OPEN) this.socket_.send(JSON.stringify(message));
    }

    sendBinary(buffer) {
        if (this.socket_?.readyState === WebSocket.OPEN) this.socket_.send(buffer);
    }

    // The server's ok, or a rejection that holds its error.
    request(op, fields = {}) {
        return new Promise((resolve, reject) => {
            if (this.socket_?.readyState !== WebSocket.OPEN) {
                reject({ code: 'lost', message: 'The connection is lost.' });
                return;
            }
            const id = ++this.lastId_;
            this.requests_.set(id, { resolve, reject });
            this.send({ op, id, ...fields });
        });
    }

    hello_() {
        const fields = this.handlers_.hello();
        this.request('hello', {
            client: { name: 'caustream-web', version: '1' },
            caps: ['jpeg', 'png', 'raw', 'f16', 'f32'],
            max_inflight: 6,    // a long way holds more frames; on a short one the server keeps to two
            ...fields,
        }).catch((error) => {
            if (error.code === 'lost') return;
            this.handlers_.refused(error);
            if (error.fatal) return;
            // What was right for the last server may be wrong for this one: a fresh session, then the document as a change.
            if (fields.resume) {
                this.handlers_.forget();
                this.hello_();
            } else {
                // Whom this page follows may not be there yet; what a server cannot do, it will not be able to in a second.
                this.refusal_ = error;
                this.socket_?.close();
            }
        });
    }

    ping_() {
        if (performance.now() - this.heardMs_ > kSilenceMs) this.lost_(0);
        else if (this.ready) this.send({ op: 'ping', t_us: Math.round(performance.now() * 1000) });
    }

    receive_(data) {
        this.heardMs_ = performance.now();
        if (data instanceof ArrayBuffer) {
            this.handlers_.frame(data, Math.round(performance.now() * 1000));
            return;
        }
        const message = JSON.parse(data);
        if (message.op === 'welcome') {
            this.ready = true;
            this.backoff_.reset();
            this.requests_.delete(message.id);
            this.handlers_.link('open');
            this.handlers_.welcome(message);
        } else if (message.op === 'ok' || message.op === 'error') {
            this.answer_(message);
        } else if (message.op === 'pong') {
            this.handlers_.roundTrip(message.t_us, message.server_us, performance.now() * 1000);
        } else if (message.op === 'goaway') {
            this.comeBackMs_ = comeBackMs(message);
            const url = new URL(this.url_);
            url.searchParams.delete('srv');     // the one that was asked for is going
            this.url_ = url.href;
        } else {
            this.handlers_[message.op]?.(message);
        }
    }

    answer_(message) {
        const request = this.requests_.get(message.id);
        this.requests_.delete(message.id);
        if (message.fatal && message.retry_ms) this.comeBackMs_ = comeBackMs({ reconnect_ms: message.retry_ms, jitter_ms: message.retry_ms / 2 });
        if (message.op === 'ok') request?.resolve(message);
        else if (request) request.reject(message);
        else this.handlers_.refused(message);
    }

    lost_(code) {
        clearInterval(this.pingTimer_);
        clearTimeout(this.retryTimer_);
        this.ready = false;
        const socket = this.socket_;
        this.socket_ = null;
        socket?.close();
        for (const { reject } of this.requests_.values()) reject({ code: 'lost', message: 'The connection is lost.' });
        this.requests_.clear();

        const closing = closingOf(code);
        if (code === kAuthRequired) return this.handlers_.link('auth', closing.why);
        const why = this.refusal_?.message ?? closing.why;
        if (!closing.retry || this.refusal_?.code === 'unsupported') return this.handlers_.link('ended', sentence({ message: why }));
        const waitMs = this.comeBackMs_ ?? this.backoff_.next();
        this.handlers_.link('retry', why, waitMs);
        this.retryTimer_ = setTimeout(() => this.connect(), waitMs);
    }
}

// What an error message says, as one sentence.
export function sentence(error) {
    const text = error.message || error.code || 'The server refused.';
    const end = /[.!?]$/.test(text) ? '' : '.';
    if (error.field && /^(must|is|has|may)\b/.test(text)) return `${error.field} ${text}${end}`;
    const start = text.charAt(0).toUpperCase() + text.slice(1);
    return error.field ? `${start.replace(/\.$/, '')} (${error.field}).` : start + end;
}
