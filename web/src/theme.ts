// SPDX-License-Identifier: Apache-2.0
// Light or dark theme, by default that of the system, and the colours that follow it.
import { Color } from 'three';

const listeners: (() => void)[] = [];

export function onThemeChange(listener: () => void): void {
  listeners.push(listener);
}

/** A colour of the page's style sheet. */
export function cssText(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export function cssColor(name: string): Color {
  return new Color(cssText(name));
}

/** The style sheet has the dark colours once, for dark systems; the button applies them on any system. */
function makeDarkAvailable(): void {
  for (const sheet of Array.from(document.styleSheets))
    for (const rule of Array.from(sheet.cssRules)) {
      if (!(rule instanceof CSSMediaRule) || rule.conditionText !== '(prefers-color-scheme: dark)') continue;
      const colours = rule.cssRules[0];
      if (colours instanceof CSSStyleRule)
        sheet.insertRule(`@media screen { :root[data-theme='dark'] { ${colours.style.cssText} } }`, sheet.cssRules.length);
      return;
    }
}

export function addThemeButton(bar: HTMLElement): void {
  makeDarkAvailable();
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const isDark = () => (document.documentElement.dataset.theme ?? (dark.matches ? 'dark' : 'light')) === 'dark';
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'theme';
  const show = () => {
    button.textContent = isDark() ? 'Light' : 'Dark';
    button.setAttribute('aria-label', isDark() ? 'Light colours' : 'Dark colours');
  };
  const tell = () => {
    show();
    for (const listener of listeners) listener();
  };
  button.addEventListener('click', () => {
    document.documentElement.dataset.theme = isDark() ? 'light' : 'dark';
    tell();
  });
  dark.addEventListener('change', tell);
  show();
  bar.append(button);
}
