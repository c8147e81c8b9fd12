// SPDX-License-Identifier: Apache-2.0
// Long signals of the page: 16-bit codes in base64 (src/kinfer/report/parts/packed.hpp).

export interface Packed {
  zero: number;
  step: number;
  packed: string;
}

const missing = 65535;

export function unpacked(signal: Packed): (number | null)[] {
  const bytes = atob(signal.packed);
  const numbers: (number | null)[] = [];
  for (let i = 0; i + 1 < bytes.length; i += 2) {
    const steps = bytes.charCodeAt(i) + 256 * bytes.charCodeAt(i + 1);
    numbers.push(steps === missing ? null : signal.zero + signal.step * steps);
  }
  return numbers;
}
