// This page's copy of the state document. What the user changes is shown at once, sent, and kept, so that any server can
// be told all of it after a reconnection.

import { aimedFrom, lightPivot } from './poses.js';
import { add, length, scale, subtract } from './vector.js';

const kInputEveryMs = 15;    // a fast display must not use up the server's message limit

// RFC 7396. With keepNulls the result is again a patch that does what both did.
export function mergePatch(target, patch, keepNulls = false) {
    if (patch === null || typeof patch !== 'object' || Array.isArray(patch)) return patch;
    const isObject = target !== null && typeof target === 'object' && !Array.isArray(target);
    const merged = isObject ? { ...target } : {};
    for (const [key, value] of Object.entries(patch)) {
        if (value === null && !keepNulls) delete merged[key];
        else merged[key] = value === null ? null : mergePatch(merged[key], value, keepNulls);
    }
    return merged;
}

// A resolved document with a patch on it. What the patch takes back ("as the file says") stays as it was until the
// server's next state message tells what the file says.
function overlay(resolved, patch) {
    return mergePatch(resolved, Object.fromEntries(Object.entries(patch).filter(([, value]) => value !== null)));
}

export class Session {
    // changed() after the shown document changed; refused(error) when the server would not have a change.
    constructor(connection, { changed, refused }) {
        this.connection_ = connection;
        this.changed_ = changed;
        this.refused_ = refused;
        this.wishes = {};            // everything this page asked for
        this.resolved_ = {};         // the server's document with the file's values in it
        this.pending_ = null;        // a patch that waits for the one under way
        this.underWay_ = null;
        this.pose_ = null;           // the newest pose, not yet sent
        this.inputSeq = 0;
        this.sentMs_ = 0;
        this.scene = null;           // the server's summary of the scene
        this.home = null;            // camera and lights as the file has them
    }

    // The document as the user should see it: the server's, with what is on its way to it.
    get shown() {
        const withUnderWay = overlay(this.resolved_, this.underWay_ ?? {});
        return overlay(withUnderWay, this.pending_ ?? {});
    }

    // From the server's state message.
    resolve({ state, scene }) {
        const sceneKey = JSON.stringify(state.scene);
        this.scene = scene;
        if (this.home?.sceneKey !== sceneKey) {
            const paths = Object.entries(state.lights ?? {}).map(([name, light]) => [name, this.pathOf_(light)]);
            this.home = { sceneKey, camera: state.camera, lights: state.lights, paths: Object.fromEntries(paths) };
        }
        this.resolved_ = overlay(state, this.pose_ ?? {});
        // A drag may have outlived its scene: a name that is gone would make the server refuse the whole replay.
        for (const group of ['lights', 'materials']) {
            for (const name of Object.keys(this.wishes[group] ?? {})) {
                if (!state[group]?.[name]) delete this.wishes[group][name];
            }
        }
        this.changed_();
    }

    // What a dragged light moves on: a sphere around what it is aimed at, inside the room if the file put it in one. It is
    // found once per scene: found anew after every move it would drift.
    pathOf_(light) {
        const bounds = this.scene.bounds ?? { min: [-1, -1, -1], max: [1, 1, 1] };
        const aim = this.scene.caster_bounds ?? bounds;
        const pivot = lightPivot(light, scale(add(aim.min, aim.max), 0.5));
        const inside = (point) => point.every((c, i) => c > bounds.min[i] && c < bounds.max[i]);
        const box = inside(light.position) && inside(pivot) ? bounds : null;
        return { pivot, distance: Math.max(length(subtract(light.position, pivot)), 0.01), box };
    }

    lightPath(lightName) {
        return this.home?.paths[lightName];
    }

    // The box that a light's position sliders span.
    lightRange(lightName) {
        const { pivot, distance, box } = this.lightPath(lightName);
        return box ?? { min: pivot.map((c) => c - 1.5 * distance), max: pivot.map((c) => c + 1.5 * distance) };
    }

    // Puts a light somewhere by hand: it stays aimed, and drags keep the new distance.
    placeLight(lightName, position) {
        const path = this.lightPath(lightName);
        path.distance = Math.max(length(subtract(position, path.pivot)), 0.01);
        this.pose({ lights: { [lightName]: aimedFrom(this.shown.lights[lightName], position, path.pivot) } });
    }

    // Camera and lights as the scene's file has them.
    goHome() {
        if (!this.home) return;
        const { eye, target, up, fov_y_deg } = this.home.camera;
        const lights = Object.entries(this.home.lights ?? {}).map(([name, light]) => {
            Object.assign(this.home.paths[name], this.pathOf_(light));
            return [name, { position: light.position, direction: light.direction }];
        });
        this.pose({ camera: { eye, target, up, fov_y_deg }, lights: Object.fromEntries(lights) });
    }

    // One update at a time: what changes meanwhile goes together with the next.
    change(patch) {
        this.pending_ = mergePatch(this.pending_ ?? {}, patch, true);
        this.changed_();
        this.flush_();
    }

    async flush_() {
        if (this.underWay_ || !this.pending_ || !this.connection_.ready) return;
        const patch = this.pending_;
        this.underWay_ = patch;
        this.posedMeanwhile_ = {};
        this.pending_ = null;
        try {
            await this.connection_.request('update', { patch });
            this.keep_(patch);
            this.keep_(this.posedMeanwhile_);
        } catch (error) {
            if (error.code === 'lost') this.pending_ = mergePatch(patch, this.pending_ ?? {}, true);
            else this.refused_(error);
        }
        this.underWay_ = null;
        this.changed_();
        this.flush_();
    }

    keep_(patch) {
        this.wishes = mergePatch(this.wishes, patch);
        this.resolved_ = overlay(this.resolved_, patch);
    }

    // Another scene starts from its file: names that both scenes use must not carry old overrides over.
    showScene(scene) {
        this.change({ scene, lights: null, materials: null, camera: null, environment: null, outside_index: null });
    }

    // A pose of camera or lights; the newest wins.
    pose(patch) {
        this.pose_ = mergePatch(this.pose_ ?? {}, patch);
        this.keep_(patch);
        if (this.underWay_) this.posedMeanwhile_ = mergePatch(this.posedMeanwhile_, patch);
        this.changed_();
    }

    // Once per animation frame: sends the newest pose, if there is one.
    sendPose(nowMs) {
        if (!this.pose_ || !this.connection_.ready || nowMs - this.sentMs_ < kInputEveryMs) return;
        this.sentMs_ = nowMs;
        this.connection_.send({ op: 'input', seq: ++this.inputSeq, t_us: Math.round(nowMs * 1000), ...this.pose_ });
        this.pose_ = null;
    }

    // After a welcome: what the server must know again before the stream starts.
    async replay(welcome) {
        this.id = welcome.session;
        this.rev = welcome.rev;
        const wishes = this.pending_ ? mergePatch(this.wishes, this.pending_, true) : this.wishes;
        this.pending_ = null;
        if (!Object.keys(wishes).length) return;
        await this.connection_.request('update', { patch: wishes });
        this.keep_(wishes);
        this.changed_();
    }

    forget() {
        this.id = null;
        this.wishes = {};
    }

    // For hello: the session to go on with, and its document for a server that has lost it.
    resumption() {
        return this.id ? { resume: { session: this.id, state: this.wishes, rev: this.rev, input_seq: this.inputSeq } } : {};
    }
}
