// @sparkjsdev/spark. `options.exact`: the options nearest to 3DGS, instead of the defaults: the blur of scenes trained
// without anti-aliasing, order by depth, the whole kernel, and colours above 1.

import * as THREE from 'three';
import { SparkRenderer, SplatMesh } from '@sparkjsdev/spark';
import { until } from './until.js';

const exact = {
  preBlurAmount: 0.3, blurAmount: 0, sortRadial: false, maxStdDev: Math.sqrt(2 * Math.log(255)), minAlpha: 1 / 255,
  accumExtSplats: true,
};

export async function create({ canvas, width, height, url, options, camera: first }) {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: false });
  renderer.setPixelRatio(1);
  renderer.setSize(width, height, false);
  renderer.setClearColor(0, 1);
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(first.fov, width / height, first.near, first.far);
  const spark = new SparkRenderer({ renderer, ...(options.exact && exact) });
  const mesh = new SplatMesh({ url, ...(options.exact && { extSplats: true }) });
  scene.add(spark, mesh);
  await mesh.initialized;

  let orders = 0, watched = null;
  const watch = () => {
    const worker = spark.sortWorker;
    if (!worker || worker === watched) return;
    watched = worker;
    const call = worker.call.bind(worker);
    worker.call = async (...given) => {
      const result = await call(...given);
      ++orders;
      return result;
    };
  };
  const isSorted = () => !spark.sorting && !spark.sortDirty;
  return {
    gl: renderer.getContext(),
    setCamera({ eye, target, up }) {
      camera.up.set(...up);
      camera.position.set(...eye);
      camera.lookAt(...target);
      camera.updateMatrixWorld(true);
    },
    draw() {
      watch();
      renderer.render(scene, camera);
    },
    orders: () => orders,
    async settle() {
      await until(isSorted);
      await spark.update({ scene, camera });
      watch();
      await until(() => isSorted() && spark.activeSplats > 0);
    },
  };
}
