// The state document as this page wants it: what a server has taken, and what one has still to hear. The native clients
// have the same in client/connection/document.h.

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);

// RFC 7396.
export function mergePatch(target, patch) {
    if (!isObject(patch)) return patch;
    const merged = isObject(target) ? { ...target } : {};
    for (const [key, value] of Object.entries(patch)) {
        if (value === null) delete merged[key];
        else merged[key] = mergePatch(merged[key], value);
    }
    return merged;
}

// The patch of all that `wanted` says and `has` does not; empty when it says it all.
export function lacking(has, wanted) {
    const patch = {};
    for (const [key, value] of Object.entries(wanted)) {
        if (isObject(has[key]) && isObject(value)) {
            const inner = lacking(has[key], value);
            if (Object.keys(inner).length) patch[key] = inner;
        } else if (JSON.stringify(has[key]) !== JSON.stringify(value)) {
            patch[key] = value;
        }
    }
    return patch;
}

// Whether one patch can do what `patch` and then `next` do: what the first takes out, the second must not fill again.
function canExtend(patch, next) {
    return Object.entries(next).every(([key, value]) =>
        !(key in patch) || !isObject(value) || (isObject(patch[key]) && canExtend(patch[key], value)));
}

function extend(patch, next) {
    const both = { ...patch };
    for (const [key, value] of Object.entries(next)) both[key] = isObject(value) && isObject(both[key]) ? extend(both[key], value) : value;
    return both;
}

function append(patches, patch) {
    const last = patches.at(-1);
    if (Object.keys(patch).length === 0) return;
    if (last && canExtend(last, patch)) patches[patches.length - 1] = extend(last, patch);
    else patches.push(patch);
}

export class Document {
    constructor() {
        this.taken = {};       // what a server has taken, to be resumed from
        this.told_ = [];       // {id, patch, settled}: since the oldest that has no answer yet; id 0: what moved
        this.waiting_ = [];    // patches with their nulls, not yet sent
    }

    // All that was asked for, without what a server refused.
    wanted() {
        return this.unheard().reduce(mergePatch, this.taken);
    }

    // The patches on top of what was taken, oldest first.
    unheard() {
        return [...this.told_.map((told) => told.patch), ...this.waiting_];
    }

    // It is sent later.
    keep(patch) {
        append(this.waiting_, patch);
    }

    // The next to be sent, or nothing. It counts as told.
    next(id) {
        const patch = this.waiting_.shift();
        if (patch) this.told_.push({ id, patch, settled: false });
        return patch;
    }

    // It is sent, and there will be no answer.
    moved(patch) {
        const last = this.told_.at(-1);
        if (!last) this.taken = mergePatch(this.taken, patch);
        else if (last.id === 0) last.patch = mergePatch(last.patch, patch);
        else this.told_.push({ id: 0, patch, settled: true });
    }

    answered(id, taken) {
        this.told_ = this.told_.filter((told) => told.id !== id || taken);
        for (const told of this.told_) if (told.id === id) told.settled = true;
        while (this.told_[0]?.settled) this.taken = mergePatch(this.taken, this.told_.shift().patch);
    }

    // The connection broke: what was not answered has still to be heard.
    lost() {
        const all = [];
        this.unheard().forEach((patch) => append(all, patch));
        this.told_ = [];
        this.waiting_ = all;
    }

    // A server is there and has the document `has`: that which it was given, or part of it; of which only `members` are
    // ours to change (nothing: all). What it lacks waits before all the rest.
    meet(has, members) {
        const ours = members ? Object.fromEntries(Object.entries(has).filter(([key]) => members.includes(key))) : has;
        const patch = lacking(ours, this.taken);
        if (Object.keys(patch).length) this.waiting_.unshift(patch);
        this.taken = ours;
    }

    // resolved: the server's document with the file's values. A light or material that this scene lacks would make the
    // next server refuse all the rest.
    prune(resolved) {
        if (JSON.stringify(this.taken.scene) !== JSON.stringify(resolved.scene)) return;
        for (const group of ['lights', 'materials']) {
            const mine = Object.entries(this.taken[group] ?? {});
            if (mine.length) this.taken = { ...this.taken, [group]: Object.fromEntries(mine.filter(([name]) => resolved[group]?.[name])) };
        }
    }
}
