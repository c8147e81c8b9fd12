// SPDX-License-Identifier: Apache-2.0
// Drawing of a chain: bars from joint to joint, a drum about each axis, the tool.
import { Group, Vector3 } from 'three';
import { Bar, Rod, sphere, solid } from './bodies';
import type { Chain, PlacedChain } from './chain';

export interface Look {
  colour: string;
  jointColour: string;
  opacity: number;
  thickness: number; // of a bar, relative to the machine's radius
}

/** Corners of the path from one frame to the next: along the axis first, as a link is built. */
function corners(placed: PlacedChain, i: number): Vector3[] {
  const joint = placed.joints[i]!;
  return [joint.parent, joint.point, joint.elbow, new Vector3().setFromMatrixPosition(joint.frame)];
}

export class Skeleton {
  readonly group = new Group();
  private readonly links: Rod[] = [];
  private readonly drums: Bar[] = [];
  private readonly toolBar: Bar;
  private readonly toolBall;

  constructor(private readonly chain: Chain, private readonly radius: number, private readonly look: Look) {
    const body = solid(look.colour, look.opacity);
    const joint = solid(look.jointColour, look.opacity);
    const thick = look.thickness * radius;
    for (const part of chain.json.joints) {
      this.links.push(new Rod(4, thick, body));
      if (part.type !== 'fixed') this.drums.push(new Bar(1.9 * thick, joint));
    }
    this.toolBar = new Bar(0.7 * thick, body);
    this.toolBall = sphere(1.3 * thick, joint);
    this.group.add(
      ...this.links.map((link) => link.group),
      ...this.drums.map((drum) => drum.mesh),
      this.toolBar.mesh,
      this.toolBall,
    );
  }

  /** `displaced`: where a point is drawn instead (exaggerated differences). */
  lay(placed: PlacedChain, displaced: (i: number, corner: number, at: Vector3) => Vector3 = (_i, _k, at) => at): void {
    const half = 2.6 * this.look.thickness * this.radius;
    let drum = 0;
    placed.joints.forEach((joint, i) => {
      this.links[i]!.lay(corners(placed, i).map((at, k) => displaced(i, k, at)));
      if (this.chain.json.joints[i]!.type === 'fixed') return;
      const at = displaced(i, 1, joint.point);
      const along = joint.axis.clone().multiplyScalar(half);
      this.drums[drum++]!.lay(at.clone().sub(along), at.clone().add(along));
    });
    const last = placed.joints.length;
    const flange = placed.joints[this.chain.json.tip]?.frame ?? placed.base;
    const tool = displaced(last, 1, new Vector3().setFromMatrixPosition(placed.tool));
    this.toolBar.lay(displaced(last, 0, new Vector3().setFromMatrixPosition(flange)), tool);
    this.toolBall.position.copy(tool);
  }

  /** The same corners for two chains, so that their difference can be exaggerated. */
  static corner(chain: Chain, placed: PlacedChain, i: number, k: number): Vector3 {
    if (i < placed.joints.length) return corners(placed, i)[k]!;
    const flange = placed.joints[chain.json.tip]?.frame ?? placed.base;
    return new Vector3().setFromMatrixPosition(k === 0 ? flange : placed.tool);
  }
}
