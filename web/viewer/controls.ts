// Input on the canvas (pointers, wheel and keys) as calls of a viewer.
//
//   const detach = attachControls(canvas, viewer);
//
// - One finger or the left button turns the scene, or the camera when flying. Two fingers move and
//   zoom. The right or middle button, or Shift with the left button, moves. Two quick taps centre a
//   point. The wheel zooms towards the pointer; when flying, it changes the speed.
// - W A S D Q E fly while they are held: Shift fast, Alt slow. Arrows turn; with Shift they move. + and
//   - zoom.
//
// The canvas becomes focusable and gets a description, unless the page has set these attributes. It
// receives keys only with the focus. A viewer without a scene ignores the calls.

import type { Viewer, Vec3 } from './types.js';

/** Factors for Shift and Alt while flying, as in the desktop window. */
const fastFactor = 4, slowFactor = 0.25;
/** Distance ratio of one step of Viewer.dolly: a step removes a tenth of the distance. */
const stepRatio = 1 / 0.9;
/** An arrow key turns by 3 degrees: a drag over the canvas's height is half a turn. */
const turnsPerHeight = 60;
/** Limits for a double tap in milliseconds and CSS pixels, as usual on phones. */
const doubleTapMs = 300, doubleTapPixels = 24;
/** Maximum motion of a tap, in CSS pixels. */
const tapPixels = 6;
/** Pixels and lines of one wheel notch, as reported by browsers. */
const notchPixels = 100, notchLines = 3;

/** Directions in the camera's axes, by position on the keyboard: the keys are adjacent on every layout. */
const pushes: Readonly<Record<string, Vec3>> = {
  KeyW: [0, 0, -1], KeyS: [0, 0, 1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
};

/** The steps of Viewer.dolly for a wheel event; a turn away from the user zooms in. Browsers report a
 *  pinch on a touchpad as a wheel event with Ctrl and a delta of -100 ln(ratio). */
export function wheelSteps(event: Pick<WheelEvent, 'deltaY' | 'deltaMode' | 'ctrlKey'>): number {
  if (event.deltaMode === 1) return -event.deltaY / notchLines;
  if (event.deltaMode === 2) return -event.deltaY * notchLines;
  return event.ctrlKey ? -event.deltaY / 100 / Math.log(stepRatio) : -event.deltaY / notchPixels;
}

interface Finger { x: number; y: number }

/** The pressed pointers, in CSS pixels from the canvas's corner. */
class Pointers {
  private readonly down = new Map<number, Finger>();
  private panning = false;
  /** Start of a possible tap; null for a drag. */
  private tap: Finger | null = null;
  private lastTap: (Finger & { time: number }) | null = null;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly viewer: Viewer) {}

  press(event: PointerEvent): void {
    // A second finger causes a pointerdown; a second button of the same mouse does not.
    const finger = this.place(event);
    this.down.set(event.pointerId, finger);
    try {
      this.canvas.setPointerCapture(event.pointerId);
    } catch { /* the pointer is already released */ }
    this.panning = event.button !== 0 || event.shiftKey;
    this.tap = this.down.size === 1 && !this.panning ? finger : null;
  }

  move(event: PointerEvent): void {
    const before = this.down.get(event.pointerId);
    if (!before) return;
    const now = this.place(event);
    if (this.tap && Math.hypot(now.x - this.tap.x, now.y - this.tap.y) > tapPixels) this.tap = null;
    if (this.down.size === 1) this.drag(now.x - before.x, now.y - before.y);
    if (this.down.size === 2) this.pinch(event.pointerId, before, now);
    this.down.set(event.pointerId, now);
  }

  release(event: PointerEvent): void {
    if (!this.down.delete(event.pointerId) || !this.tap) return;
    const { x, y } = this.tap;
    this.tap = null;
    if (event.type !== 'pointerup') return;
    const last = this.lastTap;
    const twice = last && event.timeStamp - last.time < doubleTapMs &&
        Math.hypot(x - last.x, y - last.y) < doubleTapPixels;
    this.lastTap = twice ? null : { x, y, time: event.timeStamp };
    if (twice) this.viewer.focus(x, y);
  }

  forget(): void {
    this.down.clear();
    this.tap = null;
  }

  place(event: MouseEvent): Finger {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private drag(dx: number, dy: number): void {
    if (this.panning) this.viewer.pan(dx, dy);
    else if (this.viewer.mode === 'orbit') this.viewer.orbit(dx, dy);
    else this.viewer.look(dx, dy);
  }

  /** Handles the motion of one of two fingers: their midpoint moves the scene, their distance zooms. */
  private pinch(id: number, before: Finger, now: Finger): void {
    const other = [...this.down].find(([otherId]) => otherId !== id)?.[1];
    if (!other) return;
    this.viewer.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    const from = Math.hypot(before.x - other.x, before.y - other.y);
    const to = Math.hypot(now.x - other.x, now.y - other.y);
    if (from > 0 && to > 0)
      this.viewer.dolly(Math.log(to / from) / Math.log(stepRatio),
                        [(now.x + other.x) / 2, (now.y + other.y) / 2]);
  }
}

/** The held keys for flying. */
class Flight {
  private readonly held = new Set<string>();
  private flying = false;

  constructor(private readonly viewer: Viewer) {}

  /** Handles a key event. Returns whether the key is for flying. */
  change(event: KeyboardEvent): boolean {
    const known = event.code in pushes;
    if (known && event.type === 'keydown') {
      this.held.add(event.code);
      this.viewer.mode = 'fly';
    }
    if (event.type === 'keyup') this.held.delete(event.code);
    this.tell(event.shiftKey ? fastFactor : event.altKey ? slowFactor : 1);
    return known;
  }

  /** Releases all keys: without the focus, the canvas gets no keyup events. */
  stop(): void {
    this.held.clear();
    this.tell(1);
  }

  private tell(factor: number): void {
    const sum: [number, number, number] = [0, 0, 0];
    for (const code of this.held)
      for (let axis = 0; axis < 3; ++axis) sum[axis]! += pushes[code]![axis]!;
    const length = Math.hypot(...sum);
    if (length === 0 && !this.flying) return;
    this.flying = length > 0;
    this.viewer.fly(length > 0 ? [sum[0] / length, sum[1] / length, sum[2] / length] : [0, 0, 0], factor);
  }
}

/** Handles a key that moves the view. Returns whether it was one. */
function pressKey(event: KeyboardEvent, canvas: HTMLCanvasElement, viewer: Viewer): boolean {
  if (event.key === '+' || event.key === '=' || event.key === '-' || event.key === '_') {
    viewer.dolly(event.key === '-' || event.key === '_' ? -1 : 1);
    return true;
  }
  // An arrow acts like a drag of the pointer in its direction.
  const step = canvas.clientHeight / turnsPerHeight;
  const way = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
  if (!way) return false;
  const [dx, dy] = way as [number, number];
  if (event.shiftKey) viewer.pan(dx, dy);
  else if (viewer.mode === 'orbit') viewer.orbit(dx, dy);
  else viewer.look(dx, dy);
  return true;
}

/** Sets the canvas's missing attributes. Returns a function that restores the old state. */
function describe(canvas: HTMLCanvasElement): () => void {
  const wanted = {
    tabindex: '0',
    role: 'application',
    'aria-label': 'Image of the scene. Arrow keys turn it; with Shift they move it. Plus and minus zoom. ' +
        'W, A, S, D, Q and E fly.',
  };
  const added = Object.keys(wanted).filter((name) => !canvas.hasAttribute(name));
  for (const name of added) canvas.setAttribute(name, wanted[name as keyof typeof wanted]);
  const { touchAction, userSelect } = canvas.style;
  canvas.style.touchAction = 'none';  // touches must not scroll or zoom the page
  canvas.style.userSelect = 'none';   // a double click must not select text
  return () => {
    for (const name of added) canvas.removeAttribute(name);
    Object.assign(canvas.style, { touchAction, userSelect });
  };
}

/** Connects pointers, wheel and keys on the canvas with the viewer. Returns a function that disconnects
 *  them. */
export function attachControls(canvas: HTMLCanvasElement, viewer: Viewer): () => void {
  const undescribe = describe(canvas);
  const pointers = new Pointers(canvas, viewer);
  const flight = new Flight(viewer);
  const ended = new AbortController();
  const on = <E extends keyof HTMLElementEventMap>(type: E, listener: (event: HTMLElementEventMap[E]) => void,
                                                   options: AddEventListenerOptions = {}) =>
    canvas.addEventListener(type, listener, { ...options, signal: ended.signal });

  on('pointerdown', (event) => pointers.press(event));
  on('mousedown', (event) => {
    if (event.button !== 1) return;
    event.preventDefault();  // otherwise the browser scrolls
    canvas.focus({ preventScroll: true });
  });
  on('pointermove', (event) => pointers.move(event));
  on('pointerup', (event) => pointers.release(event));
  on('pointercancel', (event) => pointers.release(event));
  on('lostpointercapture', (event) => pointers.release(event));
  on('contextmenu', (event) => event.preventDefault());
  on('wheel', (event) => {
    event.preventDefault();
    const { x, y } = pointers.place(event);
    if (viewer.mode === 'orbit') viewer.dolly(wheelSteps(event), [x, y]);
    else viewer.scaleSpeed(wheelSteps(event));
  }, { passive: false });

  on('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.defaultPrevented) return;
    if (flight.change(event) || pressKey(event, canvas, viewer)) event.preventDefault();
  });
  on('keyup', (event) => void flight.change(event));
  const rest = () => {
    flight.stop();
    pointers.forget();
  };
  on('blur', rest);
  window.addEventListener('blur', rest, { signal: ended.signal });

  return () => {
    ended.abort();
    rest();
    undescribe();
  };
}
