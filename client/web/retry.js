// When a lost server is tried again, and when it takes a person. The native clients have the same in
// client/connection/backoff.h and closing.h.

const kFirstWaitMs = 250, kLongestWaitMs = 8000, kMostMs = 60_000;

// Doubles from the first wait to the longest. Every wait is a random part of its bound, at least half of it: the many
// viewers of a server that restarts do not come back at once.
export class Backoff {
    constructor() {
        this.reset();
    }

    next(random = Math.random()) {
        const bound = this.boundMs_;
        this.boundMs_ = Math.min(2 * bound, kLongestWaitMs);
        return bound * (0.5 + 0.5 * random);
    }

    // A server took us in: the next loss begins anew.
    reset() {
        this.boundMs_ = kFirstWaitMs;
    }
}

// What a goaway, or a server that is busy, asks for.
export function comeBackMs({ reconnect_ms = 0, jitter_ms = 0 }, random = Math.random()) {
    return Math.min(kMostMs, reconnect_ms + random * jitter_ms);
}

const kFinal = {
    4401: 'This server asks for its token, or does not take this one.',
    4403: 'The server does not allow it.',
    4409: 'Another viewer has taken this session over.',
    4426: 'The server speaks another version of the protocol. Reload the page.',
};
const kPassing = { 1001: 'the server is going away', 4408: 'there was no answer', 4429: 'the server is busy', 4500: 'the renderer has failed' };

// {retry, why}: why is a sentence where there is no retry, else what follows a colon.
export function closingOf(code) {
    return code in kFinal ? { retry: false, why: kFinal[code] } : { retry: true, why: kPassing[code] ?? 'no server answers' };
}
