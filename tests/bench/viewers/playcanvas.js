// playcanvas. It sorts in a worker when the camera has turned.

import * as pc from 'playcanvas';
import { until } from './until.js';

export async function create({ canvas, width, height, url, camera: first }) {
  const graphicsDevice = await pc.createGraphicsDevice(canvas, { deviceTypes: [pc.DEVICETYPE_WEBGL2], antialias: false });
  graphicsDevice.maxPixelRatio = 1;
  const app = new pc.AppBase(canvas);
  app.init(Object.assign(new pc.AppOptions(), {
    graphicsDevice, componentSystems: [pc.CameraComponentSystem, pc.GSplatComponentSystem],
    resourceHandlers: [pc.GSplatHandler],
  }));
  app.setCanvasFillMode(pc.FILLMODE_NONE);
  app.setCanvasResolution(pc.RESOLUTION_FIXED, width, height);
  const asset = new pc.Asset('scene', 'gsplat', { url });
  app.assets.add(asset);
  await new Promise((resolve, reject) => {
    asset.once('load', resolve);
    asset.once('error', reject);
    app.assets.load(asset);
  });
  app.start();
  app.requestAnimationFrame = () => {};  // only the benchmark draws
  if (app.frameRequestId) cancelAnimationFrame(app.frameRequestId);

  const camera = new pc.Entity('camera'), splats = new pc.Entity('splats');
  camera.addComponent('camera', {
    clearColor: new pc.Color(0, 0, 0, 1), fov: first.fov, nearClip: first.near, farClip: first.far,
  });
  splats.addComponent('gsplat', { asset });
  app.root.addChild(camera);
  app.root.addChild(splats);
  let orders = 0;
  app.scene.on('gsplat:sorted', () => ++orders);
  const setCamera = ({ eye, target, up }) => {
    camera.setPosition(...eye);
    camera.lookAt(new pc.Vec3(...target), new pc.Vec3(...up));
  };
  const draw = () => app.tick(performance.now());
  const manager = () => {
    for (const { layersMap } of app.renderer.gsplatDirector?.camerasMap?.values() ?? [])
      for (const { gsplatManager } of layersMap.values()) if (gsplatManager) return gsplatManager;
    return null;
  };

  setCamera(first);
  await until(() => {
    draw();
    return manager()?.cpuSorter && orders > 0;
  });
  return {
    gl: graphicsDevice.gl, setCamera, draw,
    orders: () => orders,
    /** Starts a sort as the manager does after a turn. The next draw applies its order. */
    async settle() {
      const sorting = manager(), { cpuSorter } = sorting;
      await until(() => cpuSorter.jobsInFlight === 0);
      app.root.syncHierarchy();
      sorting.sortCpu(sorting.world.getState(sorting.world.lastWorldStateVersion));
      sorting.lastSortCameraPos.copy(camera.getPosition());
      sorting.lastSortCameraFwd.copy(camera.forward);
      sorting.sortNeeded = false;
      await until(() => cpuSorter.jobsInFlight === 0 && cpuSorter.pendingSorted);
    },
  };
}
