// SPDX-License-Identifier: Apache-2.0
// evidence.json as kinfer writes it (docs/formats.md), as far as the page draws it; long signals are packed.
import type { Packed } from './packed';

export type Triple = [number, number, number];
export type Quadruple = [number, number, number, number];

export type JointMotion = 'revolute' | 'prismatic' | 'fixed';
export type JointType = 'revolute' | 'prismatic' | 'universal' | 'spherical' | 'rigid';
export type TraceQuantity = 'acceleration' | 'rate';
export type TraceUnit = 'm/s^2' | 'rad/s';
export type TraceFrame = 'ground' | 'sensor';

export interface PoseJson {
  xyz: Triple;
  quat: Quadruple; // w x y z
}

export interface JointJson {
  name: string;
  parent: number; // index of the joint before it; -1: the base
  type: JointMotion;
  reading: number; // index into q; -1: none
  before: PoseJson;
  axis: Triple;
  after: PoseJson;
  gain: number;
  couplings: [number, number][];
  limits?: [number, number];
}

export interface ChainJson {
  name: string;
  base: PoseJson;
  joints: JointJson[];
  tip: number;
  tool: PoseJson;
  readings: string[];
}

export interface CalibrateEvidence {
  kind: 'calibrate';
  outliers: { row: number }[];
  rows: { before: (number | null)[]; after: (number | null)[]; held_out: boolean[] };
  picture: {
    chains: { nominal: ChainJson; before: ChainJson; calibrated: ChainJson };
    q: number[][];
    measured: (Triple | null)[];
    off_before: (Triple | null)[];
    off_after: (Triple | null)[];
    predicted: (number | null)[];
    workspace: { tool: Triple[]; predicted: number[] };
  };
}

export interface FoundJointJson {
  parent: string;
  child: string;
  type: JointType;
  axis_in_parent: Triple | null;
  point_in_parent: Triple | null;
  axis_in_child: Triple | null;
  point_in_child: Triple | null;
  sd: { axis_in_child_rad: [number, number]; point_in_child_m: [number, number]; [key: string]: unknown };
  not_identifiable_in_parent: Triple[];
  not_identifiable_in_child: Triple[];
}

export interface EnvelopeJson {
  low: Packed;
  high: Packed;
}

export interface TraceJson {
  sensor: string;
  quantity: TraceQuantity;
  unit: TraceUnit;
  frame: TraceFrame;
  measured: EnvelopeJson[];
  predicted: EnvelopeJson[];
  residual: EnvelopeJson[];
}

export interface MotionJson {
  time: number[];
  held_out: [number, number][];
  traces: TraceJson[];
  playback: { time: number[]; root: Quadruple[]; q: number[][] };
}

export interface IdentifyEvidence {
  kind: 'identify';
  root: string;
  joints: FoundJointJson[];
  chain: ChainJson;
  order: { sensors: string[] };
  motion: MotionJson;
}

export interface FleetEvidence {
  kind: 'fleet';
  head: string[];
  rows: (string | number | null)[][];
}

export type Evidence = CalibrateEvidence | IdentifyEvidence | FleetEvidence;

export function readEvidence(): Evidence {
  const element = document.getElementById('evidence');
  if (!element?.textContent) throw new Error('the page holds no evidence');
  return JSON.parse(element.textContent) as Evidence;
}
