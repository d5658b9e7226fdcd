// The exports of the package tureen-viewer.

export { createViewer } from '../viewer/viewer.js';
export { attachControls } from '../viewer/controls.js';
export { maxLayers, namedViews, ViewerError } from '../viewer/types.js';
export type * from '../viewer/types.js';
