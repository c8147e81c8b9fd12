// SPDX-License-Identifier: Apache-2.0
// A 3D scene: light, camera, labels that follow their points. Draws only after a change.
import {
  Box3,
  Color,
  DirectionalLight,
  GridHelper,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from 'three';
import { listen } from './gestures';
import { cssColor, onThemeChange } from './theme';

interface View {
  azimuth: number;
  elevation: number;
  distance: number;
  target: Vector3;
}

interface Name {
  element: HTMLElement;
  at: Vector3;
}

export class Stage {
  readonly scene = new Scene();
  readonly canvas: HTMLCanvasElement;
  frames = 0; // drawn so far
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(32, 1, 0.01, 1000);
  private readonly names: Name[] = [];
  private readonly layer: HTMLElement;
  private view: View = { azimuth: -0.9, elevation: 0.35, distance: 5, target: new Vector3() };
  private home: View = { ...this.view, elevation: 0.32 };
  private points: Vector3[] = [];
  private axes = { toEye: new Vector3(1, 0, 0), right: new Vector3(0, 1, 0), up: new Vector3(0, 0, 1) };
  private frameRequested = false;
  private visible = true;

  /** Throws where the browser has no WebGL. */
  constructor(private readonly host: HTMLElement, description: string) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, powerPreference: 'low-power' });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', `${description}. Arrow keys turn it, plus and minus zoom, 0 resets.`);
    this.layer = document.createElement('div');
    this.layer.className = 'names';
    this.layer.setAttribute('aria-hidden', 'true');
    host.append(this.canvas, this.layer);
    this.camera.up.set(0, 0, 1);
    const sun = new DirectionalLight(0xffffff, 2.0);
    sun.position.set(-2, -3, 5);
    this.scene.add(new HemisphereLight(0xffffff, 0x8a8f98, 1.8), sun);
    listen(this.canvas, {
      turn: (right, up) => this.turn(right, up),
      shift: (right, up) => this.shift(right, up),
      zoom: (factor) => this.zoom(factor),
      reset: () => this.reset(),
    });
    new ResizeObserver(() => this.resize()).observe(host);
    new IntersectionObserver((entries) => {
      this.visible = entries.some((entry) => entry.isIntersecting);
      if (this.visible) this.invalidate();
    }).observe(host);
    onThemeChange(() => this.invalidate());
    this.resize();
  }

  /** Points the camera so that all points are in view, and draws a floor below them. */
  fit(points: Vector3[]): void {
    const box = new Box3().setFromPoints(points);
    const radius = Math.max(0.5 * box.getSize(new Vector3()).length(), 1e-3);
    const { azimuth, elevation } = this.home;
    const toEye = new Vector3(
      Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation),
    );
    const right = new Vector3(-Math.sin(azimuth), Math.cos(azimuth), 0);
    const up = toEye.clone().cross(right);
    const target = box.getCenter(new Vector3());
    const middle = (along: Vector3) => {
      const values = points.map((p) => p.clone().sub(target).dot(along));
      return (Math.min(...values) + Math.max(...values)) / 2;
    };
    target.add(right.clone().multiplyScalar(middle(right))).add(up.clone().multiplyScalar(middle(up)));
    this.points = points;
    this.axes = { toEye, right, up };
    this.home = { azimuth, elevation, target, distance: this.distanceFor(target) };
    this.camera.near = radius / 200;
    this.camera.far = radius * 60;
    this.camera.updateProjectionMatrix();
    this.reset();
    this.layFloor(box, radius);
  }

  reset(): void {
    this.view = { ...this.home, target: this.home.target.clone() };
    this.invalidate();
  }

  name(words: string, kind: string): { place(at: Vector3): void; show(on: boolean): void } {
    const element = document.createElement('span');
    element.textContent = words;
    element.className = kind;
    this.layer.append(element);
    const name = { element, at: new Vector3() };
    this.names.push(name);
    return {
      place: (at) => name.at.copy(at),
      show: (on) => {
        element.hidden = !on;
      },
    };
  }

  add(...objects: Object3D[]): void {
    this.scene.add(...objects);
  }

  invalidate(): void {
    if (this.frameRequested || !this.visible) return;
    this.frameRequested = true;
    requestAnimationFrame(() => {
      this.frameRequested = false;
      this.draw();
    });
  }

  /** Camera distance at which every point lies within the picture, with room for labels and axes. */
  private distanceFor(target: Vector3): number {
    const high = 0.84 * Math.tan((this.camera.fov * Math.PI) / 360);
    const wide = high * this.camera.aspect;
    const { toEye, right, up } = this.axes;
    const needed = this.points.map((point) => {
      const p = point.clone().sub(target);
      return p.dot(toEye) + Math.max(Math.abs(p.dot(right)) / wide, Math.abs(p.dot(up)) / high);
    });
    return Math.max(...needed, 1e-3);
  }

  private layFloor(box: Box3, radius: number): void {
    const step = 10 ** Math.floor(Math.log10(radius));
    const cell = radius / step > 5 ? step : radius / step > 2 ? step / 2 : step / 5;
    const count = 2 * Math.ceil((1.5 * radius) / cell);
    const floor = new GridHelper(count * cell, count);
    floor.rotateX(Math.PI / 2);
    const centre = box.getCenter(new Vector3());
    floor.position.set(Math.round(centre.x / cell) * cell, Math.round(centre.y / cell) * cell, Math.min(box.min.z, 0));
    const material = floor.material;
    material.vertexColors = false;
    material.transparent = true;
    material.opacity = 0.5;
    const paint = () => material.color.copy(cssColor('--line'));
    paint();
    onThemeChange(paint);
    this.scene.add(floor);
  }

  private draw(): void {
    const { azimuth, elevation, distance, target } = this.view;
    const flat = Math.cos(elevation) * distance;
    this.camera.position.set(
      target.x + flat * Math.cos(azimuth),
      target.y + flat * Math.sin(azimuth),
      target.z + distance * Math.sin(elevation),
    );
    this.camera.lookAt(target);
    this.renderer.setClearColor(new Color(0), 0);
    this.renderer.render(this.scene, this.camera);
    this.placeNames();
    this.frames += 1;
    this.canvas.dataset.frames = String(this.frames);
  }

  private placeNames(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    const taken: { x: number; y: number }[] = [];
    for (const { element, at } of this.names) {
      const p = at.clone().project(this.camera);
      let x = (0.5 + 0.5 * p.x) * width;
      let y = (0.5 - 0.5 * p.y) * height;
      while (taken.some((other) => Math.abs(other.x - x) < 44 && Math.abs(other.y - y) < 15)) y += 15;
      taken.push({ x, y });
      x = Math.min(Math.max(x, 4), width - 40);
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    const zoomed = this.view.distance / this.home.distance;
    if (this.points.length > 0) this.home.distance = this.distanceFor(this.home.target);
    this.view.distance = zoomed * this.home.distance;
    this.invalidate();
  }

  private turn(right: number, up: number): void {
    this.view.azimuth -= right;
    this.view.elevation = Math.min(1.5, Math.max(-1.5, this.view.elevation + up));
    this.invalidate();
  }

  private zoom(factor: number): void {
    const least = this.home.distance / 40;
    this.view.distance = Math.min(this.home.distance * 5, Math.max(least, this.view.distance * factor));
    this.invalidate();
  }

  private shift(right: number, up: number): void {
    const unit = (2 * this.view.distance * Math.tan((this.camera.fov * Math.PI) / 360)) / this.host.clientHeight;
    const x = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const y = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    this.view.target.addScaledVector(x, -right * unit).addScaledVector(y, up * unit);
    this.invalidate();
  }
}
