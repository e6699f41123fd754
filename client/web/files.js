// Files in and out: a GLB that is opened or dropped goes up, a still picture comes down.
import { sentence } from './connection.js';
import { followed } from './follow.js';
import { Encoding, frameBlob } from './frame.js';
import { Upload } from './upload.js';

const byId = (id) => document.getElementById(id);

export class Files {
    // page: {status(text), problem(text), added(sha256, name)}.
    constructor(connection, session, page) {
        this.connection_ = connection;
        this.session_ = session;
        this.page_ = page;
        this.limits = null;          // from the welcome
        this.kept_ = new Map();      // sha256 -> bytes, oldest first: for another server that lacks what this page shows
        this.waiting_ = null;        // a file that a lost connection kept from being sent
        this.upload_ = null;
        this.awaited_ = null;
        this.bind_();
    }

    bind_() {
        byId('open').onclick = () => byId('file').click();
        byId('file').onchange = (event) => {
            this.open(event.target.files[0]);
            event.target.value = '';
        };
        byId('upload-cancel').onclick = () => this.upload_?.stop('The upload was cancelled.');
        const mark = (on) => byId('stage').classList.toggle('drop', on);
        addEventListener('dragover', (event) => { event.preventDefault(); mark(true); });
        addEventListener('dragleave', (event) => event.relatedTarget === null && mark(false));
        addEventListener('drop', (event) => {
            event.preventDefault();
            mark(false);
            this.open(event.dataTransfer.files[0]);
        });
    }

    async open(file) {
        if (!file || this.upload_) return;
        if (followed) return this.page_.problem("Another viewer's scene is followed: a file is opened there.");
        if (!this.connection_.ready) {
            this.waiting_ = file;
            return this.page_.problem(`${file.name} is sent when there is a connection again.`);
        }
        this.upload_ = new Upload(this.connection_, this.limits);
        byId('upload').hidden = false;
        byId('upload-name').textContent = `Sending ${file.name}`;
        try {
            const bytes = new Uint8Array(await file.arrayBuffer());
            const report = await this.upload_.run(bytes, (share) => (byId('upload-progress').value = share));
            this.keep_(report.sha256, bytes);
            this.page_.added(report.sha256, file.name);
            this.session_.showScene(['asset', report.sha256]);
            this.page_.status(`${file.name}: ${report.triangles.toLocaleString('en')} triangles`);
        } catch (error) {
            if (error.code === 'lost') this.waiting_ = file;
            else this.page_.problem(`${file.name}: ${sentence(error)}`);
        }
        this.upload_ = null;
        byId('upload').hidden = true;
        byId('upload-progress').value = 0;
    }

    // From the server's asset.credit.
    credit(message) {
        this.upload_?.credit(message);
    }

    // The oldest are forgotten beyond the size that one file may have; the newest never.
    keep_(sha256, bytes) {
        this.kept_.delete(sha256);
        this.kept_.set(sha256, bytes);
        let total = 0;
        for (const kept of this.kept_.values()) total += kept.length;
        for (const [oldest, kept] of this.kept_) {
            if (total <= (this.limits?.asset_bytes ?? 0) || oldest === sha256) break;
            total -= kept.length;
            this.kept_.delete(oldest);
        }
    }

    // After a welcome: a file that did not get through goes on.
    resume() {
        const file = this.waiting_;
        this.waiting_ = null;
        this.open(file);
    }

    // Sends again what a new server lacks of the files that were sent to the old one.
    async restore(missing) {
        for (const sha256 of missing) {
            const bytes = this.kept_.get(sha256);
            if (!bytes) continue;
            this.upload_ = new Upload(this.connection_, this.limits);
            await this.upload_.run(bytes, () => {}).finally(() => (this.upload_ = null));
        }
    }

    // A still is drawn with anti-aliasing and sent without loss, whatever the stream does.
    async savePicture(canvas) {
        const shown = this.session_.shown;
        const isPicture = shown.stream?.encoding !== 'raw';
        byId('save').disabled = true;
        try {
            if (isPicture) await this.connection_.request('update', { patch: { stream: { encoding: 'png' } } });
            const { frame_seq } = await this.connection_.request('frame.request', { still: true, converge: true });
            const frame = await new Promise((resolve, reject) => (this.awaited_ = { seq: frame_seq, resolve, reject }));
            const isPng = frame.encoding === Encoding.png;
            const blob = isPng ? frameBlob(frame) : await new Promise((done) => canvas.toBlob(done, 'image/png'));
            this.download_(blob, `caustream-${(shown.scene?.[1] ?? 'scene').slice(0, 12)}.png`);
        } catch (error) {
            this.page_.problem(sentence(error));
        }
        this.awaited_ = null;
        if (isPicture) this.connection_.request('update', { patch: { stream: { encoding: 'jpeg' } } }).catch(() => {});
        byId('save').disabled = false;
    }

    download_(blob, name) {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(blob);
        link.download = name;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
        this.page_.status(`Saved ${name}`);
    }

    // Every frame, as it arrives.
    frame(frame) {
        if (frame.seq === this.awaited_?.seq) this.awaited_.resolve(frame);
    }

    lost() {
        this.upload_?.stop('The connection was lost during the upload.', 'lost');
        this.awaited_?.reject({ message: 'The connection was lost before the picture came.' });
    }
}
