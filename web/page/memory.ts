// Stored settings: in localStorage, or only until the page is closed if that is not available (a page
// from the disk, or disabled or full storage).

const prefix = 'tureen.';
const fallback = new Map<string, string>();

/** The stored JSON value with this name; null if there is none or it is unreadable. */
export function recall(name: string): unknown {
  let text = fallback.get(name) ?? null;
  try {
    text ??= localStorage.getItem(prefix + name);
  } catch { /* no storage */ }
  try {
    return text === null ? null : JSON.parse(text);
  } catch {
    return null;
  }
}

/** Stores a value; null removes it. Returns false if it lasts only until the page is closed. */
export function remember(name: string, value: unknown): boolean {
  const text = JSON.stringify(value);
  try {
    if (value === null) localStorage.removeItem(prefix + name);
    else localStorage.setItem(prefix + name, text);
    fallback.delete(name);
    return true;
  } catch {
    fallback.set(name, text);
    return false;
  }
}
