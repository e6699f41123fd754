// What the user sees and changes of the scene. A change is shown at once, sent, and kept, so that any server can be told
// all of it after a reconnection.

import { Document, mergePatch } from './document.js';
import { aimedFrom, lightPivot } from './poses.js';
import { add, length, scale, subtract } from './vector.js';

const kInputEveryMs = 15;    // a fast display must not use up the server's message limit

// A resolved document with a patch on it. What the patch takes back ("as the file says") stays as it was until the
// server's next state message tells what the file says.
function overlay(resolved, patch) {
    return mergePatch(resolved, Object.fromEntries(Object.entries(patch).filter(([, value]) => value !== null)));
}

export class Session {
    // changed() after the shown document changed; refused(error) when the server would not have a change.
    constructor(connection, { changed, refused }, followed = null) {
        this.connection_ = connection;
        this.changed_ = changed;
        this.refused_ = refused;
        this.followed_ = followed;   // another session, whose scene is shown
        this.document_ = new Document();
        this.theirs_ = {};           // of a session that is followed: what it showed last
        this.resolved_ = {};         // the server's document with the file's values in it
        this.lastUpdate_ = 0;
        this.pose_ = null;           // the newest pose, not yet sent
        this.met_ = false;           // this server has been told what was
        this.underWay_ = false;      // an update has no answer yet
        this.inputSeq = 0;
        this.sentMs_ = 0;
        this.scene = null;           // the server's summary of the scene
        this.home = null;            // camera and lights as the file has them
        this.homes_ = new Map();     // of every scene that was shown: one may come back as it was left
    }

    // The document as the user should see it: the server's, with what is on its way to it.
    get shown() {
        return this.document_.unheard().reduce(overlay, this.resolved_);
    }

    // From the server's state message.
    resolve({ rev, state, scene }) {
        this.rev = rev;
        const sceneKey = JSON.stringify(state.scene);
        this.scene = scene;
        this.home = this.homes_.get(sceneKey);
        if (!this.home) {
            const paths = Object.entries(state.lights ?? {}).map(([name, light]) => [name, this.pathOf_(light)]);
            this.home = { camera: state.camera, lights: state.lights, paths: Object.fromEntries(paths) };
            this.homes_.set(sceneKey, this.home);
        }
        if (this.followed_) {
            const { camera, stream, ...theirs } = state;
            this.theirs_ = theirs;
        }
        this.document_.prune(state);
        // It was sent before what has moved since.
        const wanted = this.document_.wanted();
        const isOfOurs = this.followed_ || JSON.stringify(wanted.scene) === sceneKey;
        this.resolved_ = overlay(state, isOfOurs ? wanted : this.pose_ ?? {});
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
        if (this.followed_) return this.pose({ camera: { eye, target, up, fov_y_deg } });
        const lights = Object.entries(this.home.lights ?? {}).map(([name, light]) => {
            Object.assign(this.home.paths[name], this.pathOf_(light));
            return [name, { position: light.position, direction: light.direction }];
        });
        this.pose({ camera: { eye, target, up, fov_y_deg }, lights: Object.fromEntries(lights) });
    }

    change(patch) {
        this.document_.keep(patch);
        this.changed_();
        this.flush_();
    }

    // One update at a time: what changes meanwhile goes together with the next.
    async flush_() {
        while (this.met_ && !this.underWay_) {
            const id = ++this.lastUpdate_, patch = this.document_.next(id);
            if (!patch) return;
            this.underWay_ = true;
            try {
                const { rev } = await this.connection_.request('update', { patch });
                this.rev = rev ?? this.rev;
                this.document_.answered(id, true);
                this.resolved_ = overlay(this.resolved_, patch);
            } catch (error) {
                if (error.code === 'lost') return;
                this.document_.answered(id, false);
                this.refused_(error);
            }
            this.underWay_ = false;
            this.changed_();
        }
    }

    // Another scene starts from its file: names that both scenes use must not carry old overrides over.
    showScene(scene) {
        this.change({ scene, lights: null, materials: null, camera: null, environment: null, outside_index: null });
    }

    // A pose of camera or lights; the newest wins.
    pose(patch) {
        if (this.met_) {
            this.pose_ = mergePatch(this.pose_ ?? {}, patch);
            this.document_.moved(patch);
        } else {
            this.document_.keep(patch);
        }
        this.resolved_ = overlay(this.resolved_, patch);
        this.changed_();
    }

    // Once per animation frame: sends the newest pose, if there is one.
    sendPose(nowMs) {
        if (!this.pose_ || nowMs - this.sentMs_ < kInputEveryMs) return;
        this.sentMs_ = nowMs;
        this.connection_.send({ op: 'input', seq: ++this.inputSeq, t_us: Math.round(nowMs * 1000), ...this.pose_ });
        this.pose_ = null;
    }

    // The connection is gone; what changes from now on waits.
    lost() {
        this.met_ = this.underWay_ = false;
        this.pose_ = null;
        this.document_.lost();
    }

    // After a welcome: what the server must know before the stream starts.
    async replay(welcome) {
        this.id = welcome.session;
        this.rev = welcome.rev;
        this.document_.meet(this.resumed_ ? welcome.state ?? {} : {}, this.followed_ ? ['camera', 'stream'] : undefined);
        this.met_ = true;
        await this.flush_();
    }

    // The next hello asks for a new session; the document stays.
    forget() {
        this.id = null;
    }

    // For hello: the session to go on with, its document for a server that has lost it, and whom to follow.
    introduction() {
        this.resumed_ = Boolean(this.id);
        // Whom this page follows may come back after it: until then that scene is as it was seen last.
        const state = { ...this.theirs_, ...this.document_.taken };
        return {
            ...(this.followed_ ? { role: 'view', follow: this.followed_ } : {}),
            ...(this.id ? { resume: { session: this.id, state, rev: this.rev, input_seq: this.inputSeq } } : {}),
        };
    }
}
