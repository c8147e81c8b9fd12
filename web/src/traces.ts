// SPDX-License-Identifier: Apache-2.0
// Predicted against measured motion of one sensor, with the difference below; zoom by dragging, double click to reset.
import uPlot from 'uplot';
import { choice, group } from './controls';
import type { EnvelopeJson, IdentifyEvidence, TraceFrame, TraceJson, TraceQuantity, TraceUnit } from './evidence';
import { unpacked } from './packed';
import { cssText, onThemeChange } from './theme';

const axisNames = ['x', 'y', 'z'];
const height = 210;

const quantityText: Record<TraceQuantity, string> = { acceleration: 'acceleration', rate: 'angular velocity' };
const frameText: Record<TraceFrame, string> = { ground: 'world frame', sensor: 'sensor frame' };
const unitText: Record<TraceUnit, string> = { 'm/s^2': 'm/s²', 'rad/s': 'rad/s' };

function title(trace: TraceJson): string {
  return `${trace.sensor}: ${quantityText[trace.quantity]}`;
}

/** Stripes behind the curves where rows were not fitted. */
function heldOutStripes(windows: [number, number][]): uPlot.Plugin {
  return {
    hooks: {
      drawAxes: (plot: uPlot) => {
        plot.ctx.save();
        plot.ctx.fillStyle = cssText('--stripe');
        for (const [begin, end] of windows) {
          const left = Math.max(plot.valToPos(begin, 'x', true), plot.bbox.left);
          const right = Math.min(plot.valToPos(end, 'x', true), plot.bbox.left + plot.bbox.width);
          if (right > left) plot.ctx.fillRect(left, plot.bbox.top, right - left, plot.bbox.height);
        }
        plot.ctx.restore();
      },
    },
  };
}

interface Curve {
  envelope: EnvelopeJson;
  colour: string;
  words: string;
}

function plot(
  host: HTMLElement,
  time: number[],
  curves: Curve[],
  label: string,
  windows: [number, number][],
  key: string,
): uPlot {
  const colour = (name: string) => cssText(name);
  const axis: uPlot.Axis = {
    stroke: () => colour('--muted'),
    grid: { stroke: () => colour('--line'), width: 1 },
    ticks: { stroke: () => colour('--line'), width: 1, size: 5 },
    font: '12px system-ui, sans-serif',
  };
  const series: uPlot.Series[] = [{ label: 'time [s]' }];
  const bands: uPlot.Band[] = [];
  for (const curve of curves) {
    const first = series.length;
    series.push(
      { label: `${curve.words}, highest`, stroke: () => colour(curve.colour), width: 1 },
      { label: `${curve.words}, lowest`, stroke: () => colour(curve.colour), width: 1 },
    );
    bands.push({ series: [first, first + 1], fill: () => colour(curve.colour) } as uPlot.Band);
  }
  const data = [time, ...curves.flatMap((c) => [unpacked(c.envelope.high), unpacked(c.envelope.low)])] as uPlot.AlignedData;
  return new uPlot(
    {
      width: host.clientWidth || 600,
      height,
      scales: { x: { time: false } },
      legend: { show: false },
      cursor: { sync: { key }, drag: { x: true, y: false } },
      axes: [
        { ...axis, size: 34 },
        { ...axis, size: 62, label, labelSize: 20, labelFont: '12px system-ui, sans-serif' },
      ],
      series,
      bands,
      plugins: [heldOutStripes(windows)],
    },
    data,
    host,
  );
}

export function showTraces(
  evidence: IdentifyEvidence,
  goTo: (time: number) => void,
  follow: (listener: (time: number) => void) => void,
): void {
  const host = document.getElementById('traces');
  const { traces, time, held_out } = evidence.motion;
  if (!host || traces.length === 0) return;
  const upper = document.createElement('div');
  const lower = document.createElement('div');
  upper.className = 'trace';
  lower.className = 'trace';
  let which = 0;
  let axis = 0;
  let plots: uPlot[] = [];
  const marker = document.createElement('p');
  marker.className = 'legend';
  marker.innerHTML =
    '<span><i class="fill-before"></i>measured</span><span><i class="fill-after"></i>predicted</span>' +
    '<span><i class="fill-rest"></i>difference</span>' +
    (held_out.length ? '<span><i class="stripe"></i>not fitted</span>' : '');

  const draw = () => {
    for (const old of plots) old.destroy();
    const trace = traces[which]!;
    const curve = (envelopes: EnvelopeJson[], colour: string, words: string): Curve => ({
      envelope: envelopes[axis]!, colour, words,
    });
    plots = [
      plot(
        upper, time,
        [curve(trace.measured, '--before', 'measured'), curve(trace.predicted, '--after', 'predicted')],
        `${axisNames[axis]} [${unitText[trace.unit]}]`, held_out, 'traces',
      ),
      plot(lower, time, [curve(trace.residual, '--rest', 'difference')], `difference [${unitText[trace.unit]}]`, held_out, 'traces'),
    ];
    for (const p of plots)
      p.over.addEventListener('click', () => {
        const at = p.cursor.left;
        if (at !== undefined && at !== null && at >= 0) goTo(p.posToVal(at, 'x'));
      });
  };
  host.append(
    group(
      choice('Sensor', traces.map(title), (index) => {
        which = index;
        draw();
      }),
      choice('Axis', axisNames.map((name) => `${name} in the ${frameText[traces[0]!.frame]}`), (index) => {
        axis = index;
        draw();
      }),
    ),
    marker, upper, lower,
  );
  host.closest('figure')?.classList.add('live');
  draw();
  onThemeChange(draw);
  new ResizeObserver(() => {
    for (const p of plots) p.setSize({ width: upper.clientWidth, height });
  }).observe(upper);
  follow((now) => {
    for (const p of plots) p.setCursor({ left: p.valToPos(now, 'x'), top: p.over.clientHeight / 2 }, false);
  });
}
