// SPDX-License-Identifier: Apache-2.0
// The table of a fleet: sorted by a click on its head, filtered by words, and only the visible rows are in the page.
import type { FleetEvidence } from './evidence';

type Cell = string | number | null;

const rowHeight = 26; // pixels, as in style.css
const spare = 8; // rows beyond the visible ones

function shown(cell: Cell): string {
  return cell === null ? '' : String(cell);
}

function compare(a: Cell, b: Cell): number {
  if (a === null || b === null) return Number(a === null) - Number(b === null);
  return typeof a === 'number' && typeof b === 'number' ? b - a : shown(a).localeCompare(shown(b));
}

export function showFleet(evidence: FleetEvidence): void {
  const place = document.getElementById('fleet-rows');
  if (!place) return;
  document.getElementById('fleet-rows-static')?.remove();
  let rows = evidence.rows;

  const search = document.createElement('input');
  search.type = 'search';
  search.placeholder = 'Key, robot, status, sentence';
  search.setAttribute('aria-label', 'Show only rows with these words');
  const count = document.createElement('span');
  const scroll = document.createElement('div');
  scroll.className = 'fleet-scroll';
  scroll.tabIndex = 0;
  const table = document.createElement('table');
  const head = table.createTHead().insertRow();
  const above = table.createTBody();
  const body = table.createTBody();
  const below = table.createTBody();
  scroll.append(table);
  place.append(search, count, scroll);

  const spacer = (part: HTMLTableSectionElement, height: number) => {
    part.replaceChildren();
    if (height <= 0) return;
    const cell = part.insertRow().insertCell();
    cell.colSpan = evidence.head.length;
    cell.style.height = `${height}px`;
    cell.style.padding = '0';
  };
  const draw = () => {
    const first = Math.max(0, Math.floor(scroll.scrollTop / rowHeight) - spare);
    const last = Math.min(rows.length, first + Math.ceil(scroll.clientHeight / rowHeight) + 2 * spare);
    spacer(above, first * rowHeight);
    body.replaceChildren();
    for (const row of rows.slice(first, last)) {
      const line = body.insertRow();
      for (const cell of row) {
        const place = line.insertCell();
        place.textContent = shown(cell);
        if (typeof cell === 'number') place.className = 'num';
      }
    }
    spacer(below, (rows.length - last) * rowHeight);
    count.textContent = ` ${rows.length} of ${evidence.rows.length} tasks`;
  };
  evidence.head.forEach((name, column) => {
    const cell = document.createElement('th');
    cell.scope = 'col';
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = name;
    let sense = 1;
    button.addEventListener('click', () => {
      rows = [...rows].sort((a, b) => sense * compare(a[column] ?? null, b[column] ?? null));
      sense = -sense;
      draw();
    });
    cell.append(button);
    head.append(cell);
  });
  search.addEventListener('input', () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    rows = evidence.rows.filter((row) => {
      const text = row.map(shown).join(' ').toLowerCase();
      return words.every((word) => text.includes(word));
    });
    scroll.scrollTop = 0;
    draw();
  });
  scroll.addEventListener('scroll', draw, { passive: true });
  draw();
}
