// SPDX-License-Identifier: Apache-2.0
// The calibrated robot beside the nominal one: joints that move, error vectors that can be exaggerated.
import { Box3, Vector3, type Points } from 'three';
import { Strokes, cloud } from './bodies';
import { Chain, type PlacedChain } from './chain';
import { group, slider, toggle, type Slider } from './controls';
import type { CalibrateEvidence, Triple } from './evidence';
import { Skeleton } from './skeleton';
import { Stage } from './stage';

const heatClasses = 5;

function vectors(list: (Triple | null)[]): (Vector3 | null)[] {
  return list.map((v) => (v ? new Vector3(...v) : null));
}

function median(values: number[]): number {
  const sorted = values.filter(Number.isFinite).sort((a, b) => a - b);
  return sorted[sorted.length >> 1] ?? 0;
}

function millimetres(metres: number | null | undefined): string {
  if (metres === null || metres === undefined) return '–';
  const mm = Math.abs(metres * 1e3);
  return `${mm.toFixed(mm >= 100 ? 0 : mm >= 10 ? 1 : mm >= 1 ? 2 : 3)} mm`;
}

function positionText(position: number, isRevolute: boolean): string {
  return isRevolute ? `${((position * 180) / Math.PI).toFixed(1)}°` : `${(position * 1e3).toFixed(1)} mm`;
}

export class CalibrateMachine {
  private readonly stage: Stage;
  private readonly calibrated: Chain;
  private readonly before: Chain;
  private readonly body: Skeleton;
  private readonly nominalBody: Skeleton;
  private readonly errorsBefore = new Strokes('--before', 0.9);
  private readonly errorsAfter = new Strokes('--after');
  private readonly measured: (Vector3 | null)[];
  private readonly offBefore: (Vector3 | null)[];
  private readonly offAfter: (Vector3 | null)[];
  private readonly names: { place(at: Vector3): void }[];
  private readonly poseSlider: Slider;
  private readonly times: Slider;
  private readonly jointSliders: Slider[] = [];
  private q: number[];
  private exaggeration: number;

  constructor(host: HTMLElement, panel: HTMLElement, private readonly evidence: CalibrateEvidence) {
    const { picture } = evidence;
    this.calibrated = new Chain(picture.chains.calibrated);
    this.before = new Chain(picture.chains.before);
    this.measured = vectors(picture.measured);
    this.offBefore = vectors(picture.off_before);
    this.offAfter = vectors(picture.off_after);
    this.q = [...(picture.q[0] ?? new Array<number>(this.calibrated.dof).fill(0))];
    this.stage = new Stage(host, 'The robot in three dimensions');

    const space = this.extent();
    const radius = 0.5 * new Box3().setFromPoints(space).getSize(new Vector3()).length();
    this.body = new Skeleton(this.calibrated, radius, {
      colour: '--body', jointColour: '--after', opacity: 1, thickness: 0.018,
    });
    this.nominalBody = new Skeleton(this.before, radius, {
      colour: '--before', jointColour: '--before', opacity: 0.45, thickness: 0.011,
    });
    const typical = median(this.offBefore.map((v) => v?.length() ?? NaN)) || 1e-3;
    this.exaggeration = niceBelow((0.09 * radius) / typical);

    const points = cloud(this.measured.filter((v) => v !== null), 4, '--muted');
    const uncertain = this.uncertaintyCloud();
    uncertain.visible = false;
    this.stage.add(this.body.group, this.nominalBody.group, points, uncertain, this.errorsBefore.object, this.errorsAfter.object);
    this.names = this.calibrated.json.joints.map((joint) =>
      joint.type === 'fixed' ? { place: () => undefined } : this.stage.name(joint.name, 'joint'),
    );

    this.poseSlider = slider('Pose', { min: 0, max: Math.max(0, picture.q.length - 1), step: 1, value: 0 }, (k) =>
      this.showPose(k),
    );
    const most = Math.max(3, Math.log10(this.exaggeration) + 1);
    this.times = slider(
      'Exaggerate', { min: 0, max: most, step: 0.05, value: Math.log10(this.exaggeration) },
      (power) => this.exaggerate(10 ** power),
    );
    this.addPanel(panel, uncertain);
    this.stage.fit(space);
    this.exaggerate(this.exaggeration);
    this.showPose(0);
  }

  /** Moves the robot to a row of the data. */
  showPose(row: number): void {
    const q = this.evidence.picture.q[row];
    if (!q) return;
    this.q = [...q];
    this.poseSlider.input.value = String(row);
    const { before, after } = this.evidence.rows;
    const wrong = this.evidence.outliers.some((outlier) => outlier.row === row);
    this.poseSlider.show(
      `row ${row}: ${millimetres(before[row])} → ${millimetres(after[row])}${wrong ? ' (outlier)' : ''}`,
    );
    this.lay();
  }

  private extent(): Vector3[] {
    const space = this.measured.filter((point) => point !== null);
    const add = (placed: PlacedChain) => {
      for (const joint of placed.joints) space.push(joint.point, new Vector3().setFromMatrixPosition(joint.frame));
      space.push(new Vector3().setFromMatrixPosition(placed.tool), new Vector3().setFromMatrixPosition(placed.base));
    };
    const { q } = this.evidence.picture;
    const step = Math.max(1, Math.floor(q.length / 40));
    add(this.calibrated.place(this.q));
    for (let i = 0; i < q.length; i += step) add(this.calibrated.place(q[i]!));
    return space;
  }

  private uncertaintyCloud(): Points {
    const { tool, predicted } = this.evidence.picture.workspace;
    const sorted = [...predicted].sort((a, b) => a - b);
    const low = sorted[0] ?? 0;
    const high = sorted[Math.floor(0.98 * (sorted.length - 1))] ?? 1;
    const heat = (i: number) => {
      const part = (predicted[i]! - low) / Math.max(high - low, 1e-12);
      return `--heat${Math.min(heatClasses - 1, Math.max(0, Math.floor(part * heatClasses)))}`;
    };
    return cloud(tool.map((p) => new Vector3(...p)), 5, '--muted', heat);
  }

  private addPanel(panel: HTMLElement, uncertain: Points): void {
    const show = (object: { visible: boolean }) => (on: boolean) => {
      object.visible = on;
      this.stage.invalidate();
    };
    panel.append(
      group(this.poseSlider.row, this.times.row),
      group(
        toggle('nominal robot', 'before', true, show(this.nominalBody.group)),
        toggle('errors before', 'before', true, show(this.errorsBefore.object)),
        toggle('errors after', 'after', true, show(this.errorsAfter.object)),
        toggle('uncertainty over the workspace', 'heat4', false, show(uncertain)),
      ),
      this.jointPanel(),
    );
  }

  private jointPanel(): HTMLElement {
    const details = document.createElement('details');
    details.innerHTML = '<summary>Move the joints</summary>';
    const { q } = this.evidence.picture;
    this.calibrated.json.readings.forEach((name, k) => {
      const joint = this.calibrated.json.joints.find((j) => j.reading === k);
      const isRevolute = joint?.type !== 'prismatic';
      const values = q.map((row) => row[k] ?? 0);
      const [min, max] = joint?.limits ?? [Math.min(0, ...values), Math.max(0, ...values)];
      const control = slider(name, { min, max: max > min ? max : min + 1, step: 'any', value: this.q[k] ?? 0 }, (value) => {
        this.q[k] = value;
        this.poseSlider.show('moved by hand');
        this.lay();
      });
      control.input.dataset.joint = String(k);
      control.input.dataset.revolute = String(isRevolute);
      this.jointSliders.push(control);
      details.append(control.row);
    });
    return details;
  }

  private exaggerate(times: number): void {
    this.exaggeration = times;
    this.times.show(`${times >= 10 ? Math.round(times) : times.toFixed(1)} ×`);
    const pairs = (off: (Vector3 | null)[]) =>
      this.measured.flatMap((point, i) => {
        const by = off[i];
        return point && by ? [point, point.clone().addScaledVector(by, times)] : [];
      });
    this.errorsBefore.set(pairs(this.offBefore));
    this.errorsAfter.set(pairs(this.offAfter));
    this.lay();
  }

  private lay(): void {
    const placed = this.calibrated.place(this.q);
    const nominal = this.before.place(this.q);
    this.body.lay(placed);
    this.nominalBody.lay(nominal, (i, k, at) => {
      const corner = Skeleton.corner(this.calibrated, placed, i, k);
      return corner.clone().addScaledVector(at.clone().sub(corner), this.exaggeration);
    });
    placed.joints.forEach((joint, i) => this.names[i]!.place(joint.point));
    this.jointSliders.forEach((control, k) => {
      const value = this.q[k] ?? 0;
      control.input.value = String(value);
      control.show(positionText(value, control.input.dataset.revolute === 'true'));
    });
    this.stage.invalidate();
  }
}

/** 1, 2 or 5 times a power of ten, at most `value`. */
function niceBelow(value: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1)));
  const part = Math.max(value, 1) / power;
  return power * (part >= 5 ? 5 : part >= 2 ? 2 : 1);
}
