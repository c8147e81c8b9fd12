// SPDX-License-Identifier: Apache-2.0
// The plot of all poses: a tooltip at each dot, and a click that shows its pose.
import type { CalibrateEvidence } from './evidence';

function words(evidence: CalibrateEvidence, row: number): string {
  const mm = (value: number | null | undefined) => (value == null ? '–' : (value * 1e3).toFixed(3));
  const { before, after, held_out } = evidence.rows;
  return `row ${row}: ${mm(before[row])} → ${mm(after[row])} mm${held_out[row] ? ', not fitted' : ''}`;
}

function nearest(svg: SVGSVGElement, event: MouseEvent): SVGCircleElement | null {
  let best: SVGCircleElement | null = null;
  let least = 18; // pixels
  for (const dot of svg.querySelectorAll<SVGCircleElement>('circle[data-row]')) {
    const box = dot.getBoundingClientRect();
    const distance = Math.hypot(box.x + box.width / 2 - event.clientX, box.y + box.height / 2 - event.clientY);
    if (distance < least) {
      least = distance;
      best = dot;
    }
  }
  return best;
}

export function addTips(evidence: CalibrateEvidence, choose: (row: number) => void): void {
  const svg = document.querySelector<SVGSVGElement>('#per-pose svg');
  if (!svg) return;
  const tip = document.createElement('div');
  tip.className = 'tip';
  tip.hidden = true;
  document.body.append(tip);
  let chosen: SVGCircleElement | null = null;
  svg.addEventListener('mousemove', (event) => {
    const dot = nearest(svg, event);
    tip.hidden = !dot;
    svg.style.cursor = dot ? 'pointer' : '';
    if (!dot) return;
    tip.textContent = words(evidence, Number(dot.dataset.row));
    tip.style.transform = `translate(${event.pageX + 12}px, ${event.pageY - 34}px)`;
  });
  svg.addEventListener('mouseleave', () => (tip.hidden = true));
  svg.addEventListener('click', (event) => {
    const dot = nearest(svg, event);
    if (!dot) return;
    chosen?.classList.remove('chosen');
    dot.classList.add('chosen');
    chosen = dot;
    choose(Number(dot.dataset.row));
    const reduced = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    document.getElementById('machine')?.scrollIntoView({ behavior: reduced ? 'auto' : 'smooth', block: 'center' });
  });
}
