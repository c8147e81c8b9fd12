// SPDX-License-Identifier: Apache-2.0
// Controls with keyboard access: sliders with a displayed value, switches, buttons.

export interface Slider {
  row: HTMLElement;
  input: HTMLInputElement;
  show(words: string): void;
}

let serial = 0;

export function slider(
  label: string,
  range: { min: number; max: number; step: number | 'any'; value: number },
  onInput: (value: number) => void,
): Slider {
  const id = `control-${serial++}`;
  const row = document.createElement('div');
  row.className = 'control';
  row.innerHTML = `<label for="${id}"></label><input type="range" id="${id}"><output for="${id}"></output>`;
  row.querySelector('label')!.textContent = label;
  const input = row.querySelector('input')!;
  input.min = String(range.min);
  input.max = String(range.max);
  input.step = String(range.step);
  input.value = String(range.value);
  input.addEventListener('input', () => onInput(Number(input.value)));
  const output = row.querySelector('output')!;
  return {
    row,
    input,
    show(words: string) {
      output.textContent = words;
      input.setAttribute('aria-valuetext', words);
    },
  };
}

export function toggle(label: string, kind: string, on: boolean, onChange: (on: boolean) => void): HTMLElement {
  const element = document.createElement('label');
  element.className = 'switch';
  element.innerHTML = `<input type="checkbox"${on ? ' checked' : ''}><i class="${kind}"></i><span></span>`;
  element.querySelector('span')!.textContent = label;
  const input = element.querySelector('input')!;
  input.addEventListener('change', () => onChange(input.checked));
  return element;
}

export function button(label: string, kind: string, onClick: () => void): HTMLButtonElement {
  const element = document.createElement('button');
  element.type = 'button';
  element.className = kind;
  element.textContent = label;
  element.addEventListener('click', onClick);
  return element;
}

export function choice(label: string, options: string[], onChange: (index: number) => void): HTMLElement {
  const element = document.createElement('label');
  element.className = 'choice';
  const select = document.createElement('select');
  options.forEach((text, i) => select.add(new Option(text, String(i))));
  select.addEventListener('change', () => onChange(select.selectedIndex));
  const words = document.createElement('span');
  words.textContent = label;
  element.append(words, select);
  return element;
}

export function group(...children: HTMLElement[]): HTMLElement {
  const element = document.createElement('div');
  element.className = 'group';
  element.append(...children);
  return element;
}
