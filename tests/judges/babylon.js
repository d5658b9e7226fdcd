// Babylon, without drawing: it holds splats as .splat does, and harmonics in bytes.
const script = (path) => new Promise((resolve, reject) => {
  const element = document.createElement('script');
  Object.assign(element, { src: `/packages/${path}`, onload: resolve, onerror: () => reject(new Error(path)) });
  document.head.append(element);
});

export async function read(bytes, name) {
  if (!window.BABYLON) for (const path of ['fflate/umd/index.js', 'babylonjs/babylon.js', 'babylonjs-loaders/babylonjs.loaders.js'])
    await script(path);
  const scene = new BABYLON.Scene(new BABYLON.NullEngine());
  const { meshes } = await BABYLON.ImportMeshAsync(new File([bytes], name), scene, { pluginOptions: { splat: {
    keepInRam: true, fflate: window.fflate, spzLibraryUrl: `${location.origin}/packages/@adobe/spz/dist/spz.js` } } });
  const mesh = meshes.find((mesh) => mesh.splatsData);
  const floats = new Float32Array(mesh.splatsData), parts = new Uint8Array(mesh.splatsData);
  const degree = mesh.shDegree, numbers = 3 * ((degree + 1) ** 2 - 1);
  const values = new Float32Array(floats.length / 8 * (14 + numbers));
  let at = 0;
  for (let i = 0; i < floats.length / 8; ++i) {
    for (let k = 0; k < 6; ++k) values[at++] = floats[8 * i + k];
    for (let k = 0; k < 4; ++k) values[at++] = (parts[32 * i + 28 + k] - 127.5) / 127.5;
    for (const k of [3, 0, 1, 2]) values[at++] = parts[32 * i + 24 + k] / 255;
    for (let k = 0; k < numbers; ++k) values[at++] = mesh.shData[k >> 4][16 * i + (k & 15)] / 127.5 - 1;
  }
  return { degree, values };
}
