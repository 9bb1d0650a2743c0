// Small helpers for the document. Text is always set as text, never as HTML.

export function byId<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

type Attributes = Record<string, string>;

export function element(name: string, attributes: Attributes = {}, ...children: (Node | string)[]): HTMLElement {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** Sets the text only where it differs, so that a screen reader says what is new only. */
export function setText(id: string, text: string): void {
  const target = byId(id);
  if (target.textContent !== text) target.textContent = text;
}

export function number(value: number | null | undefined, digits: number, unit: string): string {
  return value === null || value === undefined ? "unknown" : `${value.toFixed(digits)} ${unit}`;
}
