// How a drag moves the camera and the light. Pure: poses in, poses out. Drags are fractions of the picture's height,
// x to the right and y down, so that the same gesture does the same on every screen.
import { add, cross, dot, length, normalize, rotate, scale, subtract } from './vector.js';

const kRadiansPerHeight = 3.0;    // a drag over the whole picture turns the camera by about half a turn
const kLightPerHeight = 1.8;      // the light is dragged with more care
const kPoleMarginCos = 0.995;     // how near to straight up or down the camera may look

// Right, up and forward of the camera, unit.
export function cameraAxes(camera) {
    const forward = normalize(subtract(camera.target, camera.eye));
    const right = normalize(cross(forward, camera.up));
    return { right, up: cross(right, forward), forward };
}

export function orbit(camera, dx, dy) {
    const worldUp = normalize(camera.up);
    const { right } = cameraAxes(camera);
    const offset = subtract(camera.eye, camera.target);
    let turned = rotate(offset, right, -dy * kRadiansPerHeight);
    if (Math.abs(dot(normalize(turned), worldUp)) > kPoleMarginCos) turned = offset;
    turned = rotate(turned, worldUp, -dx * kRadiansPerHeight);
    return { ...camera, eye: add(camera.target, turned) };
}

// What lies at the target's depth follows the pointer.
export function pan(camera, dx, dy) {
    const { right, up } = cameraAxes(camera);
    const distance = length(subtract(camera.eye, camera.target));
    const heightM = 2 * distance * Math.tan((camera.fov_y_deg * Math.PI) / 360);
    const shift = add(scale(right, -dx * heightM), scale(up, dy * heightM));
    return { ...camera, eye: add(camera.eye, shift), target: add(camera.target, shift) };
}

// factor > 1 comes nearer.
export function zoom(camera, factor) {
    const offset = scale(subtract(camera.eye, camera.target), 1 / factor);
    return length(offset) > 1e-3 ? { ...camera, eye: add(camera.target, offset) } : camera;
}

// The point that a dragged light circles: where its axis passes `centre` nearest; for a point light the centre itself.
export function lightPivot(light, centre) {
    if (light.type !== 'spot' || !light.direction) return centre;
    const axis = normalize(light.direction);
    const along = dot(subtract(centre, light.position), axis);
    return along > 1e-3 ? add(light.position, scale(axis, along)) : centre;
}

// Pushes the light along the screen and back onto its sphere around the pivot: it keeps its distance and stays aimed. A
// directional light has no place, so only its direction turns.
export function dragLight(light, camera, pivot, dx, dy) {
    const { right, up } = cameraAxes(camera);
    const push = add(scale(right, dx * kLightPerHeight), scale(up, -dy * kLightPerHeight));
    if (light.type === 'directional') {
        const from = normalize(add(scale(normalize(light.direction), -1), push));
        return { direction: scale(from, -1) };
    }
    const offset = subtract(light.position, pivot);
    const distance = length(offset);
    const from = normalize(add(normalize(offset), push));
    return aimedFrom(light, add(pivot, scale(from, distance)), pivot);
}

// The pose of the light at `position`, aimed at the pivot where it has an axis.
export function aimedFrom(light, position, pivot) {
    const pose = { position };
    if (light.type === 'spot') pose.direction = normalize(subtract(pivot, position));
    return pose;
}

// Where a point of the world is in the picture, as fractions from the top left; null behind the camera.
export function project(point, camera, aspect) {
    const { right, up, forward } = cameraAxes(camera);
    const offset = subtract(point, camera.eye);
    const depth = dot(offset, forward);
    if (depth <= 0) return null;
    const halfHeight = depth * Math.tan((camera.fov_y_deg * Math.PI) / 360);
    return [0.5 + dot(offset, right) / (2 * halfHeight * aspect), 0.5 - dot(offset, up) / (2 * halfHeight)];
}
