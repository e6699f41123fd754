// The settings: each control shows a value of the state document and changes it by a patch.
import { greyOut } from './follow.js';
import { asCauchy, bToSlider, cauchyWithin, sliderToB } from './glass.js';

const byId = (id) => document.getElementById(id);
const kMethods = [
    ['auto', 'Automatic', 'Traced for faceted glass; for curved glass refined while something moves, traced at rest'],
    ['traced', 'Traced', 'Every surface and every bounce, exactly; at rest it converges to the target error'],
    ['refined', 'Refined', 'Two surfaces of each object, from pictures of them; the fastest'],
    ['thesis', 'As published (2012)', 'The algorithm of the thesis, to compare with'],
];
const kConverging = ['auto', 'traced'];
const kGrids = [0, 128, 256, 512, 1024, 2048], kMapSizes = [256, 512, 1024, 2048];

// The target error's slider is logarithmic, from 0.1 % to 20 %.
const errorAt = (place) => Number((0.001 * 200 ** place).toPrecision(2));
const placeOf = (error) => Math.log(error / 0.001) / Math.log(200);

function fill(select, options, chosen) {
    const key = JSON.stringify(options);
    if (select.dataset.options !== key) {
        select.replaceChildren(...options.map(([value, label]) => new Option(label, value)));
        select.dataset.options = key;
    }
    select.value = chosen;
}

function show(id, position, text) {
    const slider = byId(id);
    slider.value = position;
    slider.nextElementSibling.value = text;
    slider.setAttribute('aria-valuetext', text);
}

export class Panel {
    // session: the document. view: whose look the band of raw maps changes.
    constructor(session, view) {
        this.session_ = session;
        this.view_ = view;
        this.welcome_ = { scenes: [], passes: [], glasses: [] };
        this.uploaded_ = new Map();    // sha256 -> file name
        this.wavelengthsNm_ = [];
        this.exposureEv_ = 0;
        this.lightName = null;
        this.materialName = null;
        this.bind_();
    }

    bind_() {
        const on = (id, event, action) => byId(id).addEventListener(event, (e) => action(e.target.value, e.target));
        const change = (patch) => this.session_.change(patch);
        on('scene', 'change', (value) => this.session_.showScene(JSON.parse(value)));
        on('target', 'change', (value) => this.chooseTarget_(value));
        on('band', 'change', (value) => {
            this.view_.look.band = Number(value);
            change({ stream: { bands: value === '-1' ? 'rgb' : 'wavelengths' } });
        });
        on('light', 'change', (value) => { this.lightName = value; this.refresh(); });
        ['x', 'y', 'z'].forEach((axis, i) => on(`light-${axis}`, 'input', (value) => this.placeLight_(i, Number(value))));
        on('material', 'change', (value) => { this.materialName = value; this.refresh(); });
        on('preset', 'change', (value) => value && this.disperse_(JSON.parse(value)));
        on('cauchy-a', 'input', (value) => this.cauchy_(Number(value), this.cauchyNow_()[1]));
        on('cauchy-b', 'input', (value) => this.cauchy_(this.cauchyNow_()[0], sliderToB(Number(value))));
        on('wavelengths', 'input', (value) => change({ transport: { wavelengths: this.countFor_(this.mode_(), Number(value)) } }));
        on('mode', 'change', (mode) => {
            const now = this.session_.shown.transport?.wavelengths ?? 'continuous';
            const wavelengths = Array.isArray(now) ? now.length : now;
            const transport = { mode, wavelengths: wavelengths === 'continuous' ? wavelengths : this.countFor_(mode, wavelengths) };
            // To what does not converge it means something else: how many photons.
            if (!kConverging.includes(mode)) transport.target_error = 0;
            change({ transport });
        });
        on('bounces', 'input', (value) => change({ transport: { bounces: Number(value) } }));
        on('exact-receivers', 'change', (_, box) => change({ transport: { exact_receivers: box.checked } }));
        on('target-error', 'input', (value) => change({ transport: { target_error: errorAt(Number(value)) } }));
        on('auto-exposure', 'change', (_, box) => this.expose_(box.checked ? null : this.exposureEv_));
        on('exposure', 'input', (value) => this.expose_(Number(value)));
        on('photon-grid', 'change', (value) => change({ transport: { photon_grid: Number(value) } }));
        on('map-size', 'change', (value) => change({ transport: { map_size: Number(value) } }));
    }

    mode_() {
        return this.session_.shown.transport?.mode ?? 'auto';
    }

    // 0 is the slider's first place: continuous. The published algorithm has colours for 1, 7 or 21 wavelengths.
    countFor_(mode, count) {
        if (count === 0) return 'continuous';
        return mode !== 'thesis' ? count : count < 4 ? 1 : count < 14 ? 7 : 21;
    }

    chooseTarget_(target) {
        const spectral = target === 'spectral';
        this.view_.look.band = -1;
        this.session_.change({
            stream: { target, encoding: spectral ? 'raw' : 'jpeg', sample: spectral ? 'f16' : 'u8', bands: 'rgb' },
        });
    }

    placeLight_(axis, value) {
        const light = this.light();
        if (!light?.position) return;
        const position = light.position.map((old, i) => (i === axis ? value : old));
        this.session_.placeLight(this.lightName, position);
    }

    disperse_(dispersion) {
        if (this.materialName) this.session_.change({ materials: { [this.materialName]: { dispersion } } });
    }

    cauchy_(a, b) {
        this.disperse_(cauchyWithin(a, b));
    }

    cauchyNow_() {
        return asCauchy(this.session_.shown.materials?.[this.materialName]?.dispersion);
    }

    expose_(ev) {
        this.session_.change({ camera: { exposure: ev === null ? ['auto'] : ['ev', ev] } });
    }

    light() {
        return this.session_.shown.lights?.[this.lightName];
    }

    welcome(message) {
        this.welcome_ = message;
        this.refresh();
    }

    addUploaded(sha256, name) {
        this.uploaded_.set(sha256, name);
    }

    streamInfo(info) {
        this.wavelengthsNm_ = info.wavelengths_nm ?? [];
        this.refresh();
    }

    // The exposure in use, which the slider shows while it is automatic and starts from when it is not.
    exposure(ev) {
        this.exposureEv_ = ev;
        this.refreshExposure_(this.session_.shown);
    }

    // Every control from the document.
    refresh() {
        const shown = this.session_.shown;
        const scenes = this.welcome_.scenes.map((name) => [JSON.stringify(['builtin', name]), name.charAt(0).toUpperCase() + name.slice(1)]);
        for (const [sha256, name] of this.uploaded_) scenes.push([JSON.stringify(['asset', sha256]), name]);
        const own = JSON.stringify(shown.scene);
        // Of a session that is followed, or taken up: a file that was sent from elsewhere.
        if (shown.scene && !scenes.some(([value]) => value === own)) scenes.push([own, this.session_.scene?.name || 'A file']);
        fill(byId('scene'), scenes, own);

        const target = shown.stream?.target ?? 'composite';
        const targets = [['composite', 'Picture'], ['spectral', 'Spectral map']];
        for (const pass of this.welcome_.passes ?? []) targets.push([pass, `Pass: ${pass.replaceAll('_', ' ')}`]);
        fill(byId('target'), targets, target);
        byId('band-row').hidden = target !== 'spectral';
        const bands = this.wavelengthsNm_.map((nm, i) => [i, `${nm.toFixed(0)} nm`]);
        fill(byId('band'), [[-1, 'Colour'], ...bands], this.view_.look.band);

        this.refreshLight_(shown);
        this.refreshGlass_(shown);
        this.refreshExposure_(shown);
        const transport = shown.transport ?? {};
        const count = Array.isArray(transport.wavelengths) ? transport.wavelengths.length : transport.wavelengths ?? 'continuous';
        show('wavelengths', count === 'continuous' ? 0 : count, String(count));
        fill(byId('mode'), kMethods.map(([mode, name]) => [mode, name]), this.mode_());
        byId('mode').title = kMethods.find(([mode]) => mode === this.mode_())?.[2] ?? '';
        for (const id of ['bounces-row', 'exact-receivers-row', 'target-error-row']) byId(id).hidden = !kConverging.includes(this.mode_());
        show('bounces', transport.bounces ?? 8, String(transport.bounces ?? 8));
        byId('exact-receivers').checked = transport.exact_receivers ?? false;
        const targetError = transport.target_error || 0.01;    // 0, the server's own choice, stands for one per cent
        show('target-error', placeOf(targetError), `${(100 * targetError).toFixed(targetError < 0.1 ? 1 : 0)} %`);
        const withOwn = (sizes, own) => [...new Set([...sizes, own])].sort((a, b) => a - b);
        const grid = transport.photon_grid ?? 0, mapSize = transport.map_size ?? 512;
        fill(byId('photon-grid'), withOwn(kGrids, grid).map((n) => [n, n ? `${n} × ${n}` : 'Automatic']), grid);
        fill(byId('map-size'), withOwn(kMapSizes, mapSize).map((n) => [n, `${n} × ${n}`]), mapSize);
        greyOut();
    }

    refreshLight_(shown) {
        const names = Object.keys(shown.lights ?? {});
        if (!names.includes(this.lightName)) this.lightName = names[0] ?? null;
        fill(byId('light'), names.map((name) => [name, name]), this.lightName);
        byId('light-row').hidden = names.length < 2;
        const light = this.light();
        const range = light?.position && this.session_.lightRange(this.lightName);
        ['x', 'y', 'z'].forEach((axis, i) => {
            const slider = byId(`light-${axis}`);
            slider.disabled = !light?.position || light.type === 'directional';
            if (slider.disabled) return show(`light-${axis}`, slider.value, '–');
            slider.min = Math.min(range.min[i], light.position[i]);
            slider.max = Math.max(range.max[i], light.position[i]);
            show(`light-${axis}`, light.position[i], `${light.position[i].toFixed(2)} m`);
        });
    }

    refreshGlass_(shown) {
        const casters = (this.session_.scene?.materials ?? []).filter((material) => material.caster).map((material) => material.name);
        if (!casters.includes(this.materialName)) this.materialName = casters[0] ?? null;
        fill(byId('material'), casters.map((name) => [name, name]), this.materialName);
        byId('material-row').hidden = casters.length < 2;
        const dispersion = shown.materials?.[this.materialName]?.dispersion;
        const [a, b] = asCauchy(dispersion);
        const glasses = (this.welcome_.glasses ?? []).map((glass) => [JSON.stringify(glass.dispersion), glass.name]);
        const known = glasses.some(([value]) => value === JSON.stringify(dispersion));
        fill(byId('preset'), [['', 'Own'], ...glasses], known ? JSON.stringify(dispersion) : '');
        show('cauchy-a', a, a.toFixed(4));
        show('cauchy-b', bToSlider(b), `${b.toFixed(b < 0.1 ? 5 : 3)}`);
        for (const id of ['preset', 'cauchy-a', 'cauchy-b']) byId(id).disabled = !this.materialName;
    }

    refreshExposure_(shown) {
        const exposure = shown.camera?.exposure ?? ['auto'];
        const automatic = exposure[0] === 'auto';
        byId('auto-exposure').checked = automatic;
        byId('exposure').disabled = automatic;
        const ev = automatic ? this.exposureEv_ : exposure[1];
        show('exposure', ev, `${ev.toFixed(1)} EV`);
    }
}
