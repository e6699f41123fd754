// Whether the picture on the screen rests, and which statistics are about it.

const kRestMs = 200;    // for which it is the same before it counts as one that rests

export class Rest {
    constructor() {
        this.reset();
    }

    // A new connection counts its frames from 1 again.
    reset() {
        this.stateRev_ = -1;
        this.firstSeq_ = Infinity;
        this.sinceMs_ = 0;
    }

    // A frame is on the screen. Those that follow while nothing moves are of the same state.
    painted({ seq, stateRev }) {
        if (stateRev === this.stateRev_) return;
        this.stateRev_ = stateRev;
        this.firstSeq_ = seq;
        this.sinceMs_ = performance.now();
    }

    // True if that frame is of the state that is on the screen, and this has not changed for a while.
    shows(frameSeq) {
        return frameSeq >= this.firstSeq_ && performance.now() - this.sinceMs_ >= kRestMs;
    }
}
