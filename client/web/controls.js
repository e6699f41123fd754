// Mouse, touch, wheel and keys on the picture, turned into gestures. Distances are fractions of the picture's height.

const kWheelPerZoom = 600;    // wheel pixels for a factor of e
const kKeyStep = 0.03;
const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

// gestures: {orbit(dx, dy), pan(dx, dy), light(dx, dy), zoom(factor), command(name), dragging(bool)}.
// lightMode() says whether a plain drag moves the light.
export function attachControls(canvas, gestures, lightMode) {
    const pointers = new Map();
    const height = () => canvas.clientHeight || 1;
    const middle = () => {
        const all = [...pointers.values()];
        return { x: (all[0].x + all[1].x) / 2, y: (all[0].y + all[1].y) / 2, spread: Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y) };
    };

    canvas.addEventListener('pointerdown', (event) => {
        canvas.setPointerCapture(event.pointerId);
        canvas.focus({ preventScroll: true });
        const button = event.button > 0 ? 'pan' : event.shiftKey || lightMode() ? 'light' : 'orbit';
        pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, gesture: button });
        gestures.dragging(true);
        event.preventDefault();
    });

    canvas.addEventListener('pointermove', (event) => {
        const pointer = pointers.get(event.pointerId);
        if (!pointer) return;
        const before = pointers.size > 1 ? middle() : { x: pointer.x, y: pointer.y };
        pointer.x = event.clientX;
        pointer.y = event.clientY;
        const after = pointers.size > 1 ? middle() : pointer;
        const dx = (after.x - before.x) / height(), dy = (after.y - before.y) / height();
        if (pointers.size === 1) {
            gestures[pointer.gesture](dx, dy);
        } else {
            gestures.pan(dx, dy);
            if (before.spread > 0 && after.spread > 0) gestures.zoom(after.spread / before.spread);
        }
    });

    const release = (event) => {
        pointers.delete(event.pointerId);
        if (pointers.size === 0) gestures.dragging(false);
    };
    canvas.addEventListener('pointerup', release);
    canvas.addEventListener('pointercancel', release);
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());

    canvas.addEventListener('wheel', (event) => {
        event.preventDefault();
        const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1);
        gestures.zoom(Math.exp(-Math.max(-400, Math.min(400, pixels)) / kWheelPerZoom));
    }, { passive: false });

    canvas.addEventListener('keydown', (event) => {
        const arrow = kArrows[event.key];
        const key = event.key.toLowerCase();
        if (arrow) {
            const gesture = event.ctrlKey ? 'pan' : event.shiftKey || lightMode() ? 'light' : 'orbit';
            gestures[gesture](arrow[0] * kKeyStep, arrow[1] * kKeyStep);
        } else if (event.ctrlKey || event.altKey || event.metaKey) {
            return;
        } else if (key === '+' || key === '=') {
            gestures.zoom(1.1);
        } else if (key === '-') {
            gestures.zoom(1 / 1.1);
        } else if ('lcrs'.includes(key)) {
            gestures.command({ l: 'light', c: 'camera', r: 'reset', s: 'save' }[key]);
        } else {
            return;
        }
        event.preventDefault();
    });
}
