// How a drag moves the camera and the light. Pure: poses in, poses out. Drags are fractions of the picture's height,
// x to the right and y down, so that the same gesture does the same on every screen.
import { add, cross, dot, length, normalize, rotate, scale, subtract } from './vector.js';

const kRadiansPerHeight = 3.0;    // a drag over the whole picture turns the camera by about half a turn
const kLightPerHeight = 1.8;      // the light is dragged with more care
const kPoleMarginCos = 0.995;     // how near to straight up or down the camera may look
const kLevelSin = 0.02;           // a camera rolled by less is level
const kBoxShare = 0.97;           // a light stops this far short of the walls around it
const kUp = [0, 1, 0];            // glTF's

// Right, up and forward of the camera, unit.
export function cameraAxes(camera) {
    const forward = normalize(subtract(camera.target, camera.eye));
    const right = normalize(cross(forward, camera.up));
    return { right, up: cross(right, forward), forward };
}

// A level camera stays level: files often give the camera's own up, which leans back when it looks down.
export function orbit(camera, dx, dy) {
    const { right } = cameraAxes(camera);
    const worldUp = Math.abs(dot(right, kUp)) < kLevelSin && dot(camera.up, kUp) > 0 ? kUp : normalize(camera.up);
    const offset = subtract(camera.eye, camera.target);
    let turned = rotate(offset, right, -dy * kRadiansPerHeight);
    if (Math.abs(dot(normalize(turned), worldUp)) > kPoleMarginCos) turned = offset;
    turned = rotate(turned, worldUp, -dx * kRadiansPerHeight);
    return { ...camera, eye: add(camera.target, turned), up: worldUp };
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

// How far one can go from `from` (inside the box) along the unit vector `direction` before a wall.
function reach(from, direction, box) {
    const steps = direction.map((d, i) => (d === 0 ? Infinity : ((d > 0 ? box.max : box.min)[i] - from[i]) / d));
    return kBoxShare * Math.min(...steps);
}

// Pushes the light along the screen and back onto its sphere: it keeps its distance and stays aimed. path: {pivot, distance,
// box}; walls nearer than the distance (a light in a room: box is not null) bring it closer. A directional light has no
// place, so only its direction turns.
export function dragLight(light, camera, path, dx, dy) {
    const { right, up } = cameraAxes(camera);
    const push = add(scale(right, dx * kLightPerHeight), scale(up, -dy * kLightPerHeight));
    if (light.type === 'directional') {
        const from = normalize(add(scale(normalize(light.direction), -1), push));
        return { direction: scale(from, -1) };
    }
    const from = normalize(add(normalize(subtract(light.position, path.pivot)), push));
    const distance = path.box ? Math.min(path.distance, reach(path.pivot, from, path.box)) : path.distance;
    return aimedFrom(light, add(path.pivot, scale(from, distance)), path.pivot);
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
