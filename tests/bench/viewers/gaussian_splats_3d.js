// @mkkellogg/gaussian-splats-3d. It sorts after 8 degrees or 1 unit of motion.

import { RenderMode, SceneFormat, SceneRevealMode, Viewer } from '@mkkellogg/gaussian-splats-3d';
import { until } from './until.js';

export async function create({ canvas, root, width, height, url, camera: first }) {
  canvas.remove();  // the viewer makes its own
  const viewer = new Viewer({
    rootElement: root, selfDrivenMode: false, useBuiltInControls: false, renderMode: RenderMode.Always,
    sceneRevealMode: SceneRevealMode.Instant, gpuAcceleratedSort: false,
    cameraUp: first.up, initialCameraPosition: first.eye, initialCameraLookAt: first.target,
  });
  await viewer.addSplatScene(url, { format: SceneFormat.Ply, showLoadingUI: false, progressiveLoad: false });
  const { camera, splatMesh } = viewer;
  Object.assign(camera, { fov: first.fov, near: first.near, far: first.far, aspect: width / height });
  camera.updateProjectionMatrix();

  let orders = 0;
  const update = splatMesh.updateRenderIndexes.bind(splatMesh);
  splatMesh.updateRenderIndexes = (...given) => {
    ++orders;
    return update(...given);
  };
  return {
    gl: viewer.renderer.getContext(),
    setCamera({ eye, target, up }) {
      camera.up.set(...up);
      camera.position.set(...eye);
      camera.lookAt(...target);
      camera.updateMatrixWorld(true);
    },
    draw() {
      viewer.update();
      viewer.render();
    },
    orders: () => orders,
    async settle() {
      await until(() => viewer.splatRenderReady && !viewer.sortRunning);
      const before = orders;
      await viewer.runSplatSort(true, true);
      await until(() => orders > before && !viewer.sortRunning);
    },
  };
}
