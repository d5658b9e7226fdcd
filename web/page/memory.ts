// What the page remembers: localStorage where the browser has it, else only until the page is
// closed (a page from the disk, or one whose storage is switched off or full).

const prefix = 'tureen.';
const fallback = new Map<string, string>();

/** What was written under this name, as JSON has it; null where there is nothing that can be read. */
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

/** Null takes it away. False where it is kept only until the page is closed. */
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
