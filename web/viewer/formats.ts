// The files that the viewer opens, by the ends of their names: the only list of them in TypeScript. The programs recognise
// scenes by content; a name chooses which program begins, and which file of several is the scene.

interface Kind {
  /** In lower case, with the dot or as the whole name. */
  readonly end: string;
  /** Only the program with all formats reads it. */
  readonly further: boolean;
  /** Never needs other files, so that several files are a scene each. */
  readonly alone: boolean;
}

const kind = (end: string, further: boolean, alone: boolean): Kind => ({ end, further, alone });

/** In the order in which a file of several is chosen as the scene. */
export const kinds: readonly Kind[] = [
  kind('.gltf', false, false), kind('.obj', true, false),
  kind('lod-meta.json', true, false), kind('meta.json', true, false),
  kind('.glb', false, true), kind('.off', false, true), kind('.coff', false, true), kind('.ply', false, true),
  kind('.splat', false, true), kind('.sog', true, true), kind('.ssog', true, true), kind('.spz', true, true),
  kind('.ksplat', true, true), kind('.usda', true, true), kind('.usdz', true, true), kind('.usd', true, true), kind('.usdc', true, true),
  kind('.npz', true, true), kind('.pt', true, true),
];

const kindOf = (name: string) => kinds.find(({ end }) => name.toLowerCase().endsWith(end));

/** Whether the page's own program does not read a file of this name. */
export const needsFurther = (name: string) => kindOf(name)?.further ?? false;

/** Whether a file of this name is a scene without other files. */
export const isAlone = (name: string) => kindOf(name)?.alone ?? false;

/** Whether the file names others beside it by their paths, which are fetched from there. */
export const namesOthers = (name: string) => /(?:^|\/)(?:lod-)?meta\.json$/i.test(name);
