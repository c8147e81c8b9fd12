// SPDX-License-Identifier: Apache-2.0
// Shapes of drawn machines: bars between points, spheres, boxes, lines. Colours follow the theme.
import {
  BoxGeometry,
  BufferGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  Line,
  LineBasicMaterial,
  LineDashedMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  Points,
  PointsMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
  type Material,
} from 'three';
import { cssColor, onThemeChange } from './theme';

const barShape = new CylinderGeometry(1, 1, 1, 20);
const sphereShape = new SphereGeometry(1, 18, 12);
const boxShape = new BoxGeometry(1, 1, 1);
const up = new Vector3(0, 1, 0);

function painted<M extends Material & { color: { copy(c: ReturnType<typeof cssColor>): unknown } }>(
  material: M,
  colour: string,
): M {
  const paint = () => material.color.copy(cssColor(colour));
  paint();
  onThemeChange(paint);
  return material;
}

export function solid(colour: string, opacity = 1): MeshLambertMaterial {
  return painted(
    new MeshLambertMaterial({ transparent: opacity < 1, opacity, depthWrite: opacity === 1 }),
    colour,
  );
}

/** A round bar between any two points. */
export class Bar {
  readonly mesh: Mesh;
  constructor(private readonly radius: number, material: MeshLambertMaterial) {
    this.mesh = new Mesh(barShape, material);
  }
  lay(from: Vector3, to: Vector3, radius = this.radius): void {
    const along = to.clone().sub(from);
    const length = along.length();
    this.mesh.visible = length > 1e-9;
    if (!this.mesh.visible) return;
    this.mesh.position.copy(from).addScaledVector(along, 0.5);
    this.mesh.quaternion.copy(new Quaternion().setFromUnitVectors(up, along.divideScalar(length)));
    this.mesh.scale.set(radius, length, radius);
  }
}

export function sphere(radius: number, material: MeshLambertMaterial): Mesh {
  const mesh = new Mesh(sphereShape, material);
  mesh.scale.setScalar(radius);
  return mesh;
}

export function box(size: number, material: MeshLambertMaterial): Mesh {
  const mesh = new Mesh(boxShape, material);
  mesh.scale.set(size, size * 0.7, size * 0.45);
  return mesh;
}

/** Many separate lines: pairs of points. */
export class Strokes {
  readonly object: LineSegments;
  constructor(colour: string, opacity = 1) {
    const material = painted(new LineBasicMaterial({ transparent: opacity < 1, opacity }), colour);
    this.object = new LineSegments(new BufferGeometry(), material);
    this.object.frustumCulled = false;
  }
  set(pairs: Vector3[]): void {
    const flat = pairs.flatMap((p) => [p.x, p.y, p.z]);
    this.object.geometry.setAttribute('position', new Float32BufferAttribute(flat, 3));
  }
}

export class DashedLine {
  readonly object: Line;
  constructor(colour: string, dash: number) {
    const material = painted(new LineDashedMaterial({ dashSize: dash, gapSize: dash * 0.7 }), colour);
    this.object = new Line(new BufferGeometry(), material);
    this.object.frustumCulled = false;
  }
  lay(from: Vector3, to: Vector3): void {
    this.object.geometry.setFromPoints([from, to]);
    this.object.computeLineDistances();
  }
}

/** A cloud of points, in one colour or with a colour for each point. */
export function cloud(points: Vector3[], size: number, colour: string, colourOf?: (index: number) => string): Points {
  const geometry = new BufferGeometry().setFromPoints(points);
  const material = new PointsMaterial({ size, sizeAttenuation: false });
  if (!colourOf) return new Points(geometry, painted(material, colour));
  material.vertexColors = true;
  const paint = () => {
    const flat = points.flatMap((_, i) => cssColor(colourOf(i)).toArray());
    geometry.setAttribute('color', new Float32BufferAttribute(flat, 3));
  };
  paint();
  onThemeChange(paint);
  return new Points(geometry, material);
}

/** A bent bar through points, with spheres at the corners. */
export class Rod {
  readonly group = new Group();
  private readonly bars: Bar[] = [];
  private readonly spheres: Mesh[] = [];
  constructor(corners: number, radius: number, material: MeshLambertMaterial) {
    for (let i = 0; i + 1 < corners; ++i) this.bars.push(new Bar(radius, material));
    for (let i = 0; i < corners; ++i) this.spheres.push(sphere(radius, material));
    this.group.add(...this.bars.map((bar) => bar.mesh), ...this.spheres);
  }
  lay(corners: Vector3[]): void {
    this.bars.forEach((bar, i) => bar.lay(corners[i]!, corners[i + 1]!));
    this.spheres.forEach((mesh, i) => mesh.position.copy(corners[i]!));
  }
}
