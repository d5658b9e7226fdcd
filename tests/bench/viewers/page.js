// The page that `./dev bench viewers` opens for one viewer: it moves the camera, draws, and takes times. The runner
// (tests/bench/viewers_benchmark.mjs) sets window.settings before this script, and calls the methods of window.bench.
//
// NAME.js exports create(settings), which resolves to an adapter of the viewer:
//   gl               its WebGL2 context
//   setCamera(c)     c: {eye, target, up, fov (vertical, degrees), near, far}
//   draw()           draws a frame at once, by the viewer's own code
//   settle()         resolves when the next frame has the order of this camera
//   orders()         how many orders of the splats have been applied so far
// `settings` also has canvas (width by height pixels), root (its parent), url (of the scene), options (of the case)
// and camera (the first).

/** Degrees about the up axis between two frames, and frames until the motion turns back. */
const step = 2, turnsAfter = 10;

const channel = new MessageChannel();
/** One turn of the event loop. setTimeout would wait 4 ms. */
const turn = () => new Promise((resolve) => {
  channel.port1.onmessage = resolve;
  channel.port2.postMessage(null);
});

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The camera of frame `frame` of the motion; frame 0 is the view itself. `up` has length 1. */
function cameraAt({ eye, target, ...rest }, frame) {
  const phase = frame % (2 * turnsAfter), { up } = rest;
  const angle = step * Math.min(phase, 2 * turnsAfter - phase) * Math.PI / 180;
  const from = eye.map((value, axis) => value - target[axis]), side = cross(up, from), along = dot(up, from);
  const turned = from.map((value, axis) =>
    value * Math.cos(angle) + side[axis] * Math.sin(angle) + up[axis] * along * (1 - Math.cos(angle)));
  return { eye: turned.map((value, axis) => value + target[axis]), target, ...rest };
}

/** Pixels of the canvas, which exist until the task of the draw ends: RGBA, rows from the bottom. */
function read(gl, width, height) {
  const pixels = new Uint8Array(4 * width * height), bound = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, bound);
  return pixels;
}

/** A lost context draws nothing, and so is fast. */
function requireContext(gl) {
  const error = gl.getError();
  if (gl.isContextLost() || error) throw new Error(`The context is lost, or has error ${error}.`);
}

async function open() {
  const { settings } = window, { viewer, width, height } = settings;
  const canvas = document.getElementById('canvas'), root = document.getElementById('root');
  for (const element of [canvas, root]) Object.assign(element.style, { width: `${width}px`, height: `${height}px` });
  Object.assign(canvas, { width, height });
  const adapterFile = `./${viewer}.js`;  // a variable, so that esbuild does not include all adapters
  const { create } = await import(adapterFile);
  const adapter = await create({ ...settings, canvas, root }), { gl } = adapter;
  const frame = () => {
    adapter.draw();
    read(gl, 1, 1);  // waits for the image
  };
  const settled = async (camera) => {
    adapter.setCamera(camera);
    await adapter.settle();
    frame();
  };

  await settled(settings.camera);
  requireContext(gl);
  return {
    /** From the navigation to the first whole image. */
    firstImageMs: performance.now(),

    /** Times of frames while the camera moves and orders come when the viewer has them; orders applied per frame. */
    async move(view, { frames, minFrames, maxMs }) {
      await settled(view);
      adapter.setCamera(cameraAt(view, 1));
      frame();
      await turn();
      const ms = [], orders = adapter.orders(), start = performance.now();
      while (ms.length < frames && (ms.length < minFrames || performance.now() - start < maxMs)) {
        const before = performance.now();
        adapter.setCamera(cameraAt(view, 2 + ms.length));
        frame();
        await turn();
        ms.push(performance.now() - before);
      }
      requireContext(gl);
      return { ms, orders: (adapter.orders() - orders) / ms.length };
    },

    /** RGBA in base64, rows from the bottom, in the order of this view. */
    async image(view) {
      // Twice: some viewers apply an order only in a draw.
      for (let i = 0; i < 2; ++i) {
        await settled(view);
        await turn();
      }
      adapter.draw();
      const pixels = read(gl, width, height);
      requireContext(gl);
      let text = '';
      for (let at = 0; at < pixels.length; at += 8192) text += String.fromCharCode(...pixels.subarray(at, at + 8192));
      return btoa(text);
    },
  };
}

window.bench = open();
