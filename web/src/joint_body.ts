// SPDX-License-Identifier: Apache-2.0
// A joint of the identified machine: drum, axis, its uncertainty, unobservable directions, and the links that follow.
import { Matrix4, Vector3, type Mesh, type Object3D } from 'three';
import { Bar, DashedLine, sphere, solid } from './bodies';
import type { FoundJointJson, Triple } from './evidence';

type Material = ReturnType<typeof solid>;

/** A bar from a sensor's joint to the next joint on the same segment. */
export interface LinkBody {
  bar: Bar;
  to: FoundJointJson;
}

/** Sizes of bodies [m]. */
export interface BodySize {
  radius: number; // of the machine
  thick: number; // of its bars
}

interface OpenDirection {
  line: DashedLine;
  direction: Vector3;
  frame: 'parent' | 'child';
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

export function at(point: Triple | null, frame: Matrix4): Vector3 {
  return point ? new Vector3(...point).applyMatrix4(frame) : new Vector3().setFromMatrixPosition(frame);
}

/** Drawn in the frame of its child's INS. */
export class JointBody {
  readonly sure: Bar;
  readonly place: Mesh; // an ellipsoid: uncertainty of the joint's point
  readonly open: OpenDirection[];
  private readonly oneAxis: boolean; // else a sphere about the common centre of its axes
  private readonly drum: Bar;
  private readonly centre: Mesh;
  private readonly axis: Bar;
  private readonly arm: Bar; // from the joint to the child's INS: where the sensor is mounted

  constructor(
    private readonly json: FoundJointJson,
    private readonly links: LinkBody[],
    private readonly size: BodySize,
    sure: Material,
  ) {
    const { radius, thick } = size;
    const open = (directions: Triple[], frame: 'parent' | 'child') =>
      directions.map((direction) => ({
        line: new DashedLine('--open', 0.03 * radius),
        direction: new Vector3(...direction),
        frame,
      }));
    this.oneAxis = json.type === 'revolute' || json.type === 'prismatic';
    this.drum = new Bar(this.moves() ? 2 * thick : thick, solid('--after'));
    this.centre = sphere(2.4 * thick, solid('--after'));
    this.axis = new Bar(0.22 * thick, solid('--after'));
    this.sure = new Bar(thick, sure);
    this.place = sphere(thick, sure);
    this.arm = new Bar(0.35 * thick, solid('--muted'));
    this.open = [...open(json.not_identifiable_in_parent, 'parent'), ...open(json.not_identifiable_in_child, 'child')];
  }

  objects(): Object3D[] {
    const joint: Object3D[] = this.moves() ? [this.place] : [];
    if (this.oneAxis) joint.push(this.drum.mesh, this.axis.mesh, this.sure.mesh);
    else if (this.moves()) joint.push(this.centre);
    return [this.arm.mesh, ...joint, ...this.links.map((link) => link.bar.mesh), ...this.open.map((o) => o.line.object)];
  }

  /** Places it; `exaggeration`: of the standard deviations. */
  lay(frames: Map<string, Matrix4>, exaggeration: number): void {
    const { json } = this;
    const child = frames.get(json.child);
    const parent = frames.get(json.parent);
    if (!child || !parent) return;
    const point = at(json.point_in_child, child);
    const axis = json.axis_in_child ? new Vector3(...json.axis_in_child).transformDirection(child) : new Vector3(0, 0, 1);
    const along = (half: number) => [point.clone().addScaledVector(axis, -half), point.clone().addScaledVector(axis, half)] as const;
    this.drum.lay(...along(0.055 * this.size.radius));
    this.axis.lay(...along(0.2 * this.size.radius));
    // Half of the tube's radius is the axis' uncertainty in position, the other half that of its direction at the end.
    const half = 0.2 * this.size.radius;
    const spread = across(json.sd.point_in_child_m) + half * across(json.sd.axis_in_child_rad);
    this.sure.lay(...along(half), Math.min(Math.max(spread * exaggeration, 1e-4), 0.25 * this.size.radius));
    this.centre.position.copy(point);
    this.layPlace(child, point, axis, exaggeration);
    this.arm.lay(point, at(null, child));
    for (const link of this.links) link.bar.lay(point, at(link.to.point_in_parent, child));
    for (const open of this.open) {
      const direction = open.direction.clone().transformDirection(open.frame === 'parent' ? parent : child);
      const reach = 0.3 * this.size.radius;
      open.line.lay(point.clone().addScaledVector(direction, -reach), point.clone().addScaledVector(direction, reach));
    }
  }

  private moves(): boolean {
    return this.json.type !== 'rigid';
  }

  /** Half axes are one standard deviation across the joint's axis in its child, and along it, exaggerated. */
  private layPlace(child: Matrix4, point: Vector3, axis: Vector3, exaggeration: number): void {
    const { sd, axis_in_child: own } = this.json;
    const first = perpendicular(own ? new Vector3(...own) : new Vector3(0, 0, 1)).transformDirection(child);
    const second = axis.clone().cross(first);
    const across = [sd.point_in_child_m[0], sd.point_in_child_m[1]];
    const along = this.oneAxis ? Number(sd['slide_m']) : Math.hypot(...across);
    // An unobservable point along the axis is drawn as a dashed line instead of an endless ellipsoid.
    const half = [...across, along < unknownLength ? along : Math.min(...across)].map((length) =>
      Math.min(Math.max(length * exaggeration, 1e-4), 0.25 * this.size.radius),
    );
    this.place.position.copy(point);
    this.place.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(first, second, axis));
    this.place.scale.set(half[0]!, half[1]!, half[2]!);
  }
}
