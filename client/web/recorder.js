// Whether the server writes what this session does to a file of its own.

const button = document.getElementById('record');

export class Recorder {
    // status(text); refused(error).
    constructor(connection, { status, refused }) {
        this.connection_ = connection;
        this.page_ = { status, refused };
        this.wanted_ = false;
        this.file_ = null;
        button.onclick = () => this.ask_(!this.wanted_);
    }

    // What is recorded goes on with another server, in a file there.
    welcome({ caps }) {
        button.hidden = !caps?.includes('record');
        if (this.wanted_ && !button.hidden) this.ask_(true);
    }

    lost() {
        this.file_ = null;
    }

    async ask_(on) {
        this.wanted_ = on;
        try {
            const { recording } = await this.connection_.request('record', { on });
            this.page_.status(on ? `Recording to ${recording}` : `Recorded ${this.file_ ?? ''}`);
            this.file_ = recording ?? null;
        } catch (error) {
            if (error.code === 'lost') return;
            this.wanted_ = false;
            this.page_.refused(error);
        }
        button.setAttribute('aria-pressed', this.wanted_);
        button.title = this.file_ ? `Recording to ${this.file_}` : 'The server writes what is done here to a file';
    }
}
