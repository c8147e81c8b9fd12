// SPDX-License-Identifier: Apache-2.0
// The identified machine in motion: segments, INS, axes, their uncertainty, and unobservable directions.
import { Box3, Matrix4, Quaternion, Vector3, type Mesh } from 'three';
import { Bar, sphere, box, solid } from './bodies';
import { Chain, type PlacedChain } from './chain';
import { button, group, slider, toggle, type Slider } from './controls';
import type { FoundJointJson, IdentifyEvidence } from './evidence';
import { at, JointBody, type LinkBody } from './joint_body';
import { Stage } from './stage';

export class IdentifyMachine {
  private readonly stage: Stage;
  private readonly chain: Chain;
  private readonly joints: JointBody[];
  private readonly roots: LinkBody[];
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
    this.joints = evidence.joints.map(
      (json) => new JointBody(json, this.linksFrom(json.child, body, thick), { radius: this.radius, thick }, sure),
    );
    this.roots = this.linksFrom(evidence.root, body, thick);
    this.sensors = this.drawSensors();
    this.ends = evidence.joints
      .filter((joint) => !evidence.joints.some((other) => other.parent === joint.child))
      .map((joint) => ({ joint, mesh: sphere(1.2 * thick, solid('--muted')) }));
    for (const joint of this.joints) this.stage.add(...joint.objects());
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

  private linksFrom(sensor: string, body: ReturnType<typeof solid>, thick: number): LinkBody[] {
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
        toggle('uncertainty of axes and points', 'after', true, show(this.joints.flatMap((j) => [j.sure.mesh, j.place]))),
        toggle('unobservable quantities', 'open', true, show(this.joints.flatMap((j) => j.open.map((o) => o.line.object)))),
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
    for (const joint of this.joints) joint.lay(frames, this.exaggeration);
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
}
