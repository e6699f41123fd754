// How old what a frame shows is when it is painted: since the input that it shows, by this page's clock, or since the
// change that it shows, by the server's. All times in us.

export class FrameAge {
    constructor() {
        this.newestInput_ = 0;
        this.reset();
    }

    // A new connection: another server has another clock. Inputs are counted on.
    reset() {
        this.serverAheadUs_ = null;
        this.leastRoundTripUs_ = Infinity;
        this.shownRev_ = null;
        this.ms = null;    // of the newest frame that shows a change
    }

    pong(sentUs, serverUs, receivedUs) {
        const roundTripUs = receivedUs - sentUs;
        if (roundTripUs > this.leastRoundTripUs_) return;    // the quickest errs least
        this.leastRoundTripUs_ = roundTripUs;
        this.serverAheadUs_ = serverUs - (sentUs + roundTripUs / 2);
    }

    painted(frame, paintedUs) {
        // Only the first frame with an input or a change tells its age: those that follow at rest are later for no fault
        // of their own.
        const changed = frame.stateRev !== this.shownRev_;
        this.shownRev_ = frame.stateRev;
        if (frame.inputSeq > this.newestInput_ && frame.clientUs) {
            this.newestInput_ = frame.inputSeq;
            this.ms = (paintedUs - frame.clientUs) / 1000;
        } else if (this.serverAheadUs_ !== null && changed) {
            const underWayUs = paintedUs + this.serverAheadUs_ - frame.serverUs;
            this.ms = Math.max(0, underWayUs + frame.holdUs + frame.renderUs + frame.encodeUs) / 1000;
        }
    }
}
