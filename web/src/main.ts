// SPDX-License-Identifier: Apache-2.0
// Makes the report interactive: the machine moves, plots zoom, tables can be copied.
import { CalibrateMachine } from './calibrate_machine';
import { readEvidence } from './evidence';
import { showFleet } from './fleet_table';
import { IdentifyMachine } from './identify_machine';
import { enliven } from './tables';
import { addThemeButton } from './theme';
import { addTips } from './tips';
import { showTraces } from './traces';

function enlivenMachine(): void {
  const place = document.getElementById('machine');
  const evidence = readEvidence();
  if (evidence.kind === 'fleet') return showFleet(evidence);
  if (!place) return;
  const stage = document.createElement('div');
  const panel = document.createElement('div');
  stage.className = 'stage';
  panel.className = 'panel';
  place.append(stage, panel);
  try {
    if (evidence.kind === 'calibrate') {
      const machine = new CalibrateMachine(stage, panel, evidence);
      addTips(evidence, (row) => machine.showPose(row));
    } else {
      const machine = new IdentifyMachine(stage, panel, evidence);
      showTraces(evidence, (time) => machine.showTime(time), (follow) => machine.onTime(follow));
    }
    place.classList.add('live');
  } catch (problem) {
    // Without WebGL the static drawing stays.
    stage.remove();
    panel.remove();
    console.warn('The machine cannot be shown in three dimensions here:', problem);
    if (evidence.kind === 'identify') showTraces(evidence, () => undefined, () => undefined);
  }
}

/** Printed pages show folded parts. */
function unfoldForPaper(): void {
  const folded = [...document.querySelectorAll<HTMLDetailsElement>('section details:not([open])')];
  for (const details of folded) details.open = true;
  window.addEventListener('afterprint', () => folded.forEach((details) => (details.open = false)), { once: true });
}

document.documentElement.classList.add('scripted');
window.addEventListener('beforeprint', unfoldForPaper);
const bar = document.querySelector<HTMLElement>('.bar');
if (bar) addThemeButton(bar);
enliven(document);
enlivenMachine();
document.documentElement.dataset.ready = 'true';
