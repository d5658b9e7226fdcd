// What a person does on the canvas, turned into what a viewer is asked: pointers, wheel and keys.
//
//   const detach = attachControls(canvas, viewer);
//
// - One finger or the left button turns (the scene, or the head when flying). Two fingers move and
//   pinch. Right or middle button, or Shift and left, move. Two quick taps bring a point to the
//   centre. The wheel goes nearer and farther towards the pointer or, flying, changes the speed.
// - W A S D Q E fly for as long as they are held, Shift fast and Alt slow; arrows turn, with Shift
//   they move; + and - go nearer and farther.
//
// The canvas becomes focusable and says what it is, unless its page has said so. It takes keys with
// the focus alone. No scene is needed: a viewer without one ignores what it is asked.

import type { Viewer, Vec3 } from './types.js';

/** As the desktop window's: Shift and Alt while flying. */
const fastFactor = 4, slowFactor = 0.25;
/** What Viewer.dolly takes a step: a tenth of the distance. */
const stepRatio = 1 / 0.9;
/** An arrow key turns by 3 degrees: half a turn is the canvas's height. */
const turnsPerHeight = 60;
/** Two taps are one gesture within so many milliseconds and CSS pixels, which is what phones take. */
const doubleTapMs = 300, doubleTapPixels = 24;
/** A tap may tremble by so many CSS pixels. */
const tapPixels = 6;
/** Pixels of a notch of a wheel, and lines of one, as browsers report them. */
const notchPixels = 100, notchLines = 3;

/** By place on the keyboard, so that they lie together on every layout. In the camera's axes. */
const pushes: Readonly<Record<string, Vec3>> = {
  KeyW: [0, 0, -1], KeyS: [0, 0, 1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
};

/** How many steps of Viewer.dolly a turn of the wheel stands for: away from the person is nearer.
 *  A pinch on a touchpad comes as a wheel with Ctrl whose delta is -100 ln(ratio). */
export function wheelSteps(event: Pick<WheelEvent, 'deltaY' | 'deltaMode' | 'ctrlKey'>): number {
  if (event.deltaMode === 1) return -event.deltaY / notchLines;
  if (event.deltaMode === 2) return -event.deltaY * notchLines;
  return event.ctrlKey ? -event.deltaY / 100 / Math.log(stepRatio) : -event.deltaY / notchPixels;
}

interface Finger { x: number; y: number }

/** The pointers that are down, in CSS pixels from the canvas's corner. */
class Pointers {
  private readonly down = new Map<number, Finger>();
  private panning = false;
  /** Where the first one of a tap came down; null once it is a drag. */
  private tap: Finger | null = null;
  private lastTap: (Finger & { time: number }) | null = null;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly viewer: Viewer) {}

  press(event: PointerEvent): void {
    // A second button of the same mouse does not come as a pointerdown, a second finger does.
    const finger = this.place(event);
    this.down.set(event.pointerId, finger);
    try {
      this.canvas.setPointerCapture(event.pointerId);
    } catch { /* the pointer is gone already */ }
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

  /** One of two fingers moved: the point between them takes the scene along, their distance brings
   *  it nearer. */
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

/** The keys that fly, while they are held. */
class Flight {
  private readonly held = new Set<string>();
  private flying = false;

  constructor(private readonly viewer: Viewer) {}

  /** Whether the key is one of flying's. */
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

  /** Keys that are let go of elsewhere are never reported. */
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

/** Whether the key was one that moves the view. */
function pressKey(event: KeyboardEvent, canvas: HTMLCanvasElement, viewer: Viewer): boolean {
  if (event.key === '+' || event.key === '=' || event.key === '-' || event.key === '_') {
    viewer.dolly(event.key === '-' || event.key === '_' ? -1 : 1);
    return true;
  }
  // The scene, or the head, goes the way the arrow points, as if a pointer had dragged it there.
  const step = canvas.clientHeight / turnsPerHeight;
  const way = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
  if (!way) return false;
  const [dx, dy] = way as [number, number];
  if (event.shiftKey) viewer.pan(dx, dy);
  else if (viewer.mode === 'orbit') viewer.orbit(dx, dy);
  else viewer.look(dx, dy);
  return true;
}

/** Attributes that say what the canvas is, where its page has not; returns what takes them away. */
function describe(canvas: HTMLCanvasElement): () => void {
  const wanted = {
    tabindex: '0',
    role: 'application',
    'aria-label': 'Image of the scene. Arrow keys turn it, with Shift they move it; plus and minus go ' +
        'nearer and farther; W, A, S, D, Q and E fly.',
  };
  const added = Object.keys(wanted).filter((name) => !canvas.hasAttribute(name));
  for (const name of added) canvas.setAttribute(name, wanted[name as keyof typeof wanted]);
  const { touchAction, userSelect } = canvas.style;
  canvas.style.touchAction = 'none';  // the page neither scrolls nor zooms under these fingers
  canvas.style.userSelect = 'none';   // nor does a double click select what is beside
  return () => {
    for (const name of added) canvas.removeAttribute(name);
    Object.assign(canvas.style, { touchAction, userSelect });
  };
}

/** Lets pointers, wheel and keys on the canvas move the view, until what is returned is called. */
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
    event.preventDefault();  // or the browser scrolls
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
