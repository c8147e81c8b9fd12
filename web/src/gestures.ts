// SPDX-License-Identifier: Apache-2.0
// Pointer, wheel and keys of a 3D scene.

/** Camera movements, in radians, pixels and factors of the distance. */
export interface CameraControl {
  turn(right: number, up: number): void;
  shift(right: number, up: number): void;
  zoom(factor: number): void;
  reset(): void;
}

export function listen(canvas: HTMLCanvasElement, camera: CameraControl): void {
  const pointers = new Map<number, { x: number; y: number }>();
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  const release = (event: PointerEvent) => pointers.delete(event.pointerId);
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x;
    const dy = event.clientY - last.y;
    const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
    if (others[0]) {
      const before = Math.hypot(last.x - others[0].x, last.y - others[0].y);
      const now = Math.hypot(event.clientX - others[0].x, event.clientY - others[0].y);
      camera.zoom(before / Math.max(now, 1));
      camera.shift(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) {
      camera.shift(dx, dy);
    } else {
      camera.turn(dx * 0.008, dy * 0.008);
    }
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('dblclick', () => camera.reset());
  // The wheel scrolls the page until the machine was clicked.
  canvas.addEventListener(
    'wheel',
    (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      camera.zoom(Math.exp(event.deltaY * 0.0012));
    },
    { passive: false },
  );
  const keys: Record<string, () => void> = {
    ArrowLeft: () => camera.turn(-0.12, 0),
    ArrowRight: () => camera.turn(0.12, 0),
    ArrowUp: () => camera.turn(0, 0.09),
    ArrowDown: () => camera.turn(0, -0.09),
    '+': () => camera.zoom(0.87),
    '=': () => camera.zoom(0.87),
    '-': () => camera.zoom(1.15),
    '0': () => camera.reset(),
    Home: () => camera.reset(),
  };
  canvas.addEventListener('keydown', (event) => {
    const action = keys[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
