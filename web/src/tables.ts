// SPDX-License-Identifier: Apache-2.0
// Tables: copied as CSV with all digits, long ones folded.

function csvCell(text: string): string {
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** The table as CSV: exact values where a cell has them, the displayed text elsewhere. */
export function tableCsv(table: HTMLTableElement): string {
  const line = (row: HTMLTableRowElement) =>
    [...row.cells].map((cell) => csvCell(cell.dataset.v ?? cell.textContent?.trim() ?? '')).join(',');
  return [...table.rows].map(line).join('\n') + '\n';
}

async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = document.createElement('textarea'); // pages opened from a disk may not have a clipboard
    area.value = text;
    area.style.position = 'fixed';
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    return done;
  }
}

function addCopyButton(holder: HTMLElement, table: HTMLTableElement): void {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'copy';
  button.textContent = 'Copy as CSV';
  button.addEventListener('click', async () => {
    button.textContent = (await copy(tableCsv(table))) ? 'Copied' : 'Not allowed here';
    setTimeout(() => (button.textContent = 'Copy as CSV'), 1500);
  });
  holder.prepend(button);
}

function addUnfoldButton(holder: HTMLElement, table: HTMLTableElement): void {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'unfold';
  const folded = `Show all ${table.tBodies[0]?.rows.length ?? 0} rows`;
  button.textContent = folded;
  button.addEventListener('click', () => {
    const open = holder.classList.toggle('open');
    button.textContent = open ? 'Show fewer' : folded;
  });
  holder.append(button);
}

export function enliven(root: ParentNode): void {
  for (const holder of root.querySelectorAll<HTMLElement>('.table')) {
    const table = holder.querySelector('table');
    if (!table) continue;
    addCopyButton(holder, table);
    if (holder.classList.contains('folded')) addUnfoldButton(holder, table);
  }
}
