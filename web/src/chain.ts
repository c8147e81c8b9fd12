// SPDX-License-Identifier: Apache-2.0
// Forward kinematics of a chain: parent_T_joint = before · (rotation about or shift along the axis) · after.
import { Matrix4, Quaternion, Vector3 } from 'three';
import type { ChainJson, JointJson, PoseJson } from './evidence';

export function matrixOf(pose: PoseJson): Matrix4 {
  const [w, x, y, z] = pose.quat;
  return new Matrix4().compose(
    new Vector3(...pose.xyz),
    new Quaternion(x, y, z, w).normalize(),
    new Vector3(1, 1, 1),
  );
}

function variableOf(joint: JointJson, q: readonly number[]): number {
  const own = joint.reading >= 0 ? joint.gain * (q[joint.reading] ?? 0) : 0;
  return joint.couplings.reduce((sum, [k, factor]) => sum + factor * (q[k] ?? 0), own);
}

export interface PlacedJoint {
  parent: Vector3; // origin of the frame before it
  point: Vector3; // of the axis, at the joint
  elbow: Vector3; // the frame's origin, projected on the axis
  axis: Vector3; // unit; zero where it does not move
  frame: Matrix4; // world_T_joint, after its motion
}

export interface PlacedChain {
  joints: PlacedJoint[];
  base: Matrix4;
  tool: Matrix4;
}

export class Chain {
  private readonly base: Matrix4;
  private readonly tool: Matrix4;
  private readonly parts: { before: Matrix4; after: Matrix4; axis: Vector3 }[];

  constructor(readonly json: ChainJson) {
    this.base = matrixOf(json.base);
    this.tool = matrixOf(json.tool);
    this.parts = json.joints.map((joint) => ({
      before: matrixOf(joint.before),
      after: matrixOf(joint.after),
      axis: new Vector3(...joint.axis),
    }));
  }

  get dof(): number {
    return this.json.readings.length;
  }

  /** `base`: base pose other than the chain's own. */
  place(q: readonly number[], base: Matrix4 = this.base): PlacedChain {
    const joints: PlacedJoint[] = [];
    this.json.joints.forEach((joint, i) => {
      const part = this.parts[i]!;
      const parent = joint.parent < 0 ? base : joints[joint.parent]!.frame;
      const before = parent.clone().multiply(part.before);
      const variable = variableOf(joint, q);
      const moved = new Matrix4();
      if (joint.type === 'revolute') moved.makeRotationAxis(part.axis, variable);
      if (joint.type === 'prismatic') moved.makeTranslation(part.axis.clone().multiplyScalar(variable));
      const frame = before.clone().multiply(moved).multiply(part.after);
      const point = new Vector3().setFromMatrixPosition(before);
      const axis = part.axis.clone().transformDirection(before);
      if (part.axis.lengthSq() === 0) axis.set(0, 0, 0);
      const origin = new Vector3().setFromMatrixPosition(frame);
      const along = origin.clone().sub(point).dot(axis);
      joints.push({
        parent: new Vector3().setFromMatrixPosition(parent),
        point,
        elbow: point.clone().addScaledVector(axis, along),
        axis,
        frame,
      });
    });
    const tip = this.json.tip < 0 ? base : joints[this.json.tip]?.frame ?? base;
    return { joints, base, tool: tip.clone().multiply(this.tool) };
  }
}
