// Common functions for elements. The markup is in index.html and bench.html; scripts create only the
// parts that depend on a scene. Texts always become text nodes, because names come from files.

type Attributes = Readonly<Record<string, string | number | boolean | null>>;

/** The element with this id and class. Throws if the page lacks it, which is an error in the page. */
export function byId<T extends Element>(id: string, type: abstract new () => T): T {
  const found = document.getElementById(id);
  if (!(found instanceof type)) throw new Error(`The page has no ${type.name} with the id ${id}.`);
  return found;
}

export const button = (id: string) => byId(id, HTMLButtonElement);
export const input = (id: string) => byId(id, HTMLInputElement);
export const select = (id: string) => byId(id, HTMLSelectElement);
export const block = (id: string) => byId(id, HTMLElement);

/** An element with attributes (true: no value; false or null: omitted) and contents. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...contents: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (value !== false && value !== null) made.setAttribute(name, value === true ? '' : String(value));
  made.append(...contents);
  return made;
}

/** One of the page's symbols. */
export function icon(name: string): SVGSVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  const use = document.createElementNS(space, 'use');
  use.setAttribute('href', `#icon-${name}`);
  svg.setAttribute('aria-hidden', 'true');
  svg.append(use);
  return svg;
}

/** Replaces the contents of a list by sentences. The style capitalises their first letters. */
export function fillSentences(list: HTMLElement, sentences: readonly string[]): void {
  list.replaceChildren(...sentences.map((one) => make('li', { class: 'sentence' }, one)));
}

/** Replaces the contents of a dl by names and values; skips those without a value. */
export function fillFacts(list: HTMLElement, facts: readonly (readonly [string, string | null])[]): void {
  list.replaceChildren(
    ...facts.filter(([, value]) => value).map(([name, value]) =>
      make('div', {}, make('dt', {}, name), make('dd', {}, value!))));
}

/** Lets a button open a file input, and calls `picked` after each choice. The list is empty after the call. */
export function attachPicker(buttonId: string, inputId: string, picked: (files: FileList) => void): void {
  const picker = input(inputId);
  button(buttonId).addEventListener('click', () => picker.click());
  picker.addEventListener('change', () => {
    if (picker.files?.length) picked(picker.files);
    picker.value = '';  // so that the same file can be picked again
  });
}

/** Saves a file as a download of the browser. */
export function saveFile(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  make('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);  // some browsers start the download late
}

/** Whether the element is a text input. */
export function takesText(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement)
    return !['button', 'checkbox', 'color', 'radio', 'range', 'submit'].includes(target.type);
  return target instanceof HTMLTextAreaElement || (target instanceof HTMLElement && target.isContentEditable);
}
