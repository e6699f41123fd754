// Three-component vectors as plain arrays [x, y, z].
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

// The zero vector stays zero.
export function normalize(a) {
    const l = length(a);
    return l > 0 ? scale(a, 1 / l) : a;
}

// `a` turned about the unit vector `axis`, right-handed (Rodrigues 1840).
export function rotate(a, axis, radians) {
    const c = Math.cos(radians), s = Math.sin(radians);
    return add(add(scale(a, c), scale(cross(axis, a), s)), scale(axis, dot(axis, a) * (1 - c)));
}
