// SPDX-License-Identifier: Apache-2.0
// The identified machine in motion: segments, INS, axes, their uncertainty, and unobservable directions.
import { Box3, Matrix4, Quaternion, Vector3, type Mesh } from 'three';
import { Bar, DashedLine, sphere, box, solid } from './bodies';
import { Chain, type PlacedChain } from './chain';
import { button, group, slider, toggle, type Slider } from './controls';
import type { FoundJointJson, IdentifyEvidence, Triple } from './evidence';
import { Stage } from './stage';

/** A joint, drawn in the frame of its child's INS, and the link that follows it. */
interface DrawnJoint {
  json: FoundJointJson;
  oneAxis: boolean; // else a sphere about the common centre of its axes
  drum: Bar;
  centre: Mesh;
  axis: Bar;
  sure: Bar;
  place: Mesh; // an ellipsoid: uncertainty of the joint's point
  arm: Bar; // from the joint to the child's INS: where the sensor is mounted
  links: { bar: Bar; to: FoundJointJson }[];
  open: { line: DashedLine; direction: Vector3; frame: 'parent' | 'child' }[];
}

const unknownLength = 0.5; // [m] a point with a larger standard deviation counts as unobservable

/** First direction across an axis that standard deviations refer to: built from its smallest coordinate. */
function perpendicular(axis: Vector3): Vector3 {
  const size = [Math.abs(axis.x), Math.abs(axis.y), Math.abs(axis.z)];
  const unit = new Vector3();
  unit.setComponent(size.indexOf(Math.min(...size)), 1);
  return axis.clone().cross(unit).normalize();
}

function across(sd: readonly number[]): number {
  return Math.hypot(sd[0] ?? 0, sd[1] ?? 0);
}

function at(point: Triple | null, frame: Matrix4): Vector3 {
  return point ? new Vector3(...point).applyMatrix4(frame) : new Vector3().setFromMatrixPosition(frame);
}

export class IdentifyMachine {
  private readonly stage: Stage;
  private readonly chain: Chain;
  private readonly joints: DrawnJoint[];
  private readonly roots: { bar: Bar; to: FoundJointJson }[];
  private readonly sensors: Map<string, { box: Mesh; name: { place(at: Vector3): void } }>;
  private readonly ends: { joint: FoundJointJson; mesh: Mesh }[];
  private readonly radius: number;
  private readonly time: Slider;
  private readonly play: HTMLButtonElement;
  private readonly followers: ((time: number) => void)[] = [];
  private frame = 0;
  private exaggeration = 10;
  private playing = false;
  private last = 0;

  constructor(host: HTMLElement, panel: HTMLElement, private readonly evidence: IdentifyEvidence) {
    this.chain = new Chain(evidence.chain);
    this.stage = new Stage(host, 'The machine in three dimensions');
    const space = this.extent();
    this.radius = 0.5 * new Box3().setFromPoints(space).getSize(new Vector3()).length();
    const body = solid('--body');
    const sure = solid('--after', 0.28);
    const thick = 0.02 * this.radius;
    this.joints = evidence.joints.map((json) => this.draw(json, body, sure, thick));
    this.roots = this.linksFrom(evidence.root, body, thick);
    this.sensors = this.drawSensors();
    this.ends = evidence.joints
      .filter((joint) => !evidence.joints.some((other) => other.parent === joint.child))
      .map((joint) => ({ joint, mesh: sphere(1.2 * thick, solid('--muted')) }));
    for (const { bar } of this.roots) this.stage.add(bar.mesh);
    for (const end of this.ends) this.stage.add(end.mesh);

    const { playback } = evidence.motion;
    this.time = slider('Time', { min: 0, max: Math.max(0, playback.time.length - 1), step: 1, value: 0 }, (k) => {
      this.stop();
      this.show(k);
    });
    this.play = button('Play', 'play', () => (this.playing ? this.stop() : this.start()));
    this.addPanel(panel);
    this.stage.fit(space);
    this.show(0);
  }

  /** Moves the machine to a time of the log [s]. */
  showTime(time: number): void {
    this.stop();
    const { time: times } = this.evidence.motion.playback;
    let k = times.findIndex((t) => t >= time);
    if (k < 0) k = times.length - 1;
    this.show(k);
  }

  onTime(follow: (time: number) => void): void {
    this.followers.push(follow);
  }

  private draw(json: FoundJointJson, body: ReturnType<typeof solid>, sure: ReturnType<typeof solid>, thick: number): DrawnJoint {
    const moves = json.type !== 'rigid';
    const open = (directions: Triple[], frame: 'parent' | 'child') =>
      directions.map((direction) => ({
        line: new DashedLine('--open', 0.03 * this.radius),
        direction: new Vector3(...direction),
        frame,
      }));
    const oneAxis = json.type === 'revolute' || json.type === 'prismatic';
    const drawn: DrawnJoint = {
      json,
      oneAxis,
      drum: new Bar(moves ? 2 * thick : thick, solid('--after')),
      centre: sphere(2.4 * thick, solid('--after')),
      axis: new Bar(0.22 * thick, solid('--after')),
      sure: new Bar(thick, sure),
      place: sphere(thick, sure),
      arm: new Bar(0.35 * thick, solid('--muted')),
      links: this.linksFrom(json.child, body, thick),
      open: [...open(json.not_identifiable_in_parent, 'parent'), ...open(json.not_identifiable_in_child, 'child')],
    };
    this.stage.add(drawn.arm.mesh);
    if (moves) this.stage.add(drawn.place);
    if (oneAxis) this.stage.add(drawn.drum.mesh, drawn.axis.mesh, drawn.sure.mesh);
    else if (moves) this.stage.add(drawn.centre);
    for (const link of drawn.links) this.stage.add(link.bar.mesh);
    for (const { line } of drawn.open) this.stage.add(line.object);
    return drawn;
  }

  private linksFrom(sensor: string, body: ReturnType<typeof solid>, thick: number): { bar: Bar; to: FoundJointJson }[] {
    return this.evidence.joints
      .filter((joint) => joint.parent === sensor)
      .map((to) => ({ bar: new Bar(thick, body), to }));
  }

  private drawSensors(): Map<string, { box: Mesh; name: { place(at: Vector3): void } }> {
    const sensors = new Map<string, { box: Mesh; name: { place(at: Vector3): void } }>();
    const names = [this.evidence.root, ...this.evidence.joints.map((joint) => joint.child)];
    for (const name of names) {
      const mesh = box(0.075 * this.radius, solid('--ins'));
      this.stage.add(mesh);
      sensors.set(name, { box: mesh, name: this.stage.name(name, 'ins') });
    }
    return sensors;
  }

  private addPanel(panel: HTMLElement): void {
    const show = (objects: { visible: boolean }[]) => (on: boolean) => {
      for (const object of objects) object.visible = on;
      this.stage.invalidate();
    };
    const times = slider('Exaggerate ±', { min: 0, max: 3, step: 0.05, value: 1 }, (power) => {
      this.exaggeration = 10 ** power;
      times.show(`${this.exaggeration >= 10 ? Math.round(this.exaggeration) : this.exaggeration.toFixed(1)} ×`);
      this.show(this.frame);
    });
    times.show('10 ×');
    panel.append(
      group(this.play, this.time.row),
      group(times.row),
      group(
        toggle('how sure axes and points are', 'after', true, show(this.joints.flatMap((j) => [j.sure.mesh, j.place]))),
        toggle('what no signal tells', 'open', true, show(this.joints.flatMap((j) => j.open.map((o) => o.line.object)))),
      ),
    );
  }

  private start(): void {
    this.playing = true;
    this.play.textContent = 'Pause';
    this.last = performance.now();
    if (this.frame >= this.evidence.motion.playback.time.length - 1) this.frame = 0;
    const { time } = this.evidence.motion.playback;
    let now = time[this.frame] ?? 0;
    const step = (stamp: number) => {
      if (!this.playing) return;
      now += (stamp - this.last) / 1e3;
      this.last = stamp;
      let k = this.frame;
      while (k + 1 < time.length && time[k + 1]! <= now) ++k;
      if (k !== this.frame) this.show(k);
      if (k + 1 >= time.length) this.stop();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  private stop(): void {
    this.playing = false;
    this.play.textContent = 'Play';
  }

  private placedAt(k: number): PlacedChain {
    const { root, q } = this.evidence.motion.playback;
    const turn = root[Math.min(k, root.length - 1)] ?? [1, 0, 0, 0];
    const base = new Matrix4().makeRotationFromQuaternion(
      new Quaternion(turn[1], turn[2], turn[3], turn[0]).normalize(),
    );
    return this.chain.place(q[k] ?? [], base);
  }

  /** Frames of the INS in the world: those of the chain carry their names. */
  private frames(k: number): Map<string, Matrix4> {
    const placed = this.placedAt(k);
    const frames = new Map<string, Matrix4>([[this.evidence.root, placed.base]]);
    this.chain.json.joints.forEach((joint, i) => frames.set(joint.name, placed.joints[i]!.frame));
    return frames;
  }

  private extent(): Vector3[] {
    const space: Vector3[] = [];
    const { time } = this.evidence.motion.playback;
    const step = Math.max(1, Math.floor(time.length / 40));
    for (let k = 0; k < Math.max(1, time.length); k += step) {
      const frames = this.frames(k);
      for (const sensor of [this.evidence.root, ...this.evidence.joints.map((j) => j.child)]) {
        const frame = frames.get(sensor);
        if (frame) space.push(new Vector3().setFromMatrixPosition(frame));
      }
      for (const joint of this.evidence.joints) {
        const frame = frames.get(joint.child);
        if (frame) space.push(at(joint.point_in_child, frame));
      }
    }
    return space;
  }

  private show(k: number): void {
    this.frame = k;
    this.time.input.value = String(k);
    const seconds = this.evidence.motion.playback.time[k] ?? 0;
    this.time.show(`${seconds.toFixed(1)} s`);
    const frames = this.frames(k);
    const root = frames.get(this.evidence.root)!;
    for (const { bar, to } of this.roots) bar.lay(at(null, root), at(to.point_in_parent, root));
    for (const joint of this.joints) this.layJoint(joint, frames);
    for (const [name, sensor] of this.sensors) {
      const frame = frames.get(name);
      if (!frame) continue;
      sensor.box.position.setFromMatrixPosition(frame);
      sensor.box.quaternion.setFromRotationMatrix(frame);
      sensor.name.place(sensor.box.position);
    }
    for (const { joint, mesh } of this.ends) {
      const frame = frames.get(joint.child);
      if (frame) mesh.position.setFromMatrixPosition(frame);
    }
    for (const follow of this.followers) follow(seconds);
    this.stage.invalidate();
  }

  /** Half axes are one standard deviation across the joint's axis in its child, and along it, exaggerated. */
  private layPlace(joint: DrawnJoint, child: Matrix4, point: Vector3, axis: Vector3): void {
    const { sd, axis_in_child: own } = joint.json;
    const first = perpendicular(own ? new Vector3(...own) : new Vector3(0, 0, 1)).transformDirection(child);
    const second = axis.clone().cross(first);
    const across = [sd.point_in_child_m[0], sd.point_in_child_m[1]];
    const along = joint.oneAxis ? Number(sd['slide_m']) : Math.hypot(...across);
    // An unobservable point along the axis is drawn as a dashed line instead of an endless ellipsoid.
    const half = [...across, along < unknownLength ? along : Math.min(...across)].map((length) =>
      Math.min(Math.max(length * this.exaggeration, 1e-4), 0.25 * this.radius),
    );
    joint.place.position.copy(point);
    joint.place.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(first, second, axis));
    joint.place.scale.set(half[0]!, half[1]!, half[2]!);
  }

  private layJoint(joint: DrawnJoint, frames: Map<string, Matrix4>): void {
    const { json } = joint;
    const child = frames.get(json.child);
    const parent = frames.get(json.parent);
    if (!child || !parent) return;
    const point = at(json.point_in_child, child);
    const axis = json.axis_in_child ? new Vector3(...json.axis_in_child).transformDirection(child) : new Vector3(0, 0, 1);
    const along = (half: number) => [point.clone().addScaledVector(axis, -half), point.clone().addScaledVector(axis, half)] as const;
    joint.drum.lay(...along(0.055 * this.radius));
    joint.axis.lay(...along(0.2 * this.radius));
    // Half of the tube's radius is the axis' uncertainty in position, the other half that of its direction at the end.
    const half = 0.2 * this.radius;
    const spread = across(json.sd.point_in_child_m) + half * across(json.sd.axis_in_child_rad);
    joint.sure.lay(...along(half), Math.min(Math.max(spread * this.exaggeration, 1e-4), 0.25 * this.radius));
    joint.centre.position.copy(point);
    this.layPlace(joint, child, point, axis);
    joint.arm.lay(point, at(null, child));
    for (const link of joint.links) link.bar.lay(point, at(link.to.point_in_parent, child));
    for (const open of joint.open) {
      const direction = open.direction.clone().transformDirection(open.frame === 'parent' ? parent : child);
      const reach = 0.3 * this.radius;
      open.line.lay(point.clone().addScaledVector(direction, -reach), point.clone().addScaledVector(direction, reach));
    }
  }
}
