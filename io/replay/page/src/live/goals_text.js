// SPDX-License-Identifier: Apache-2.0
// The goals in force as a file that simulate_gdd --goals reads. The others stand in it as comments.

const list = (vector) => `[${vector.join(', ')}]`;
// A weight that nobody has given is left out: the goal then weighs beside others as it does here.
const numbers = (goal, ...keys) =>
  keys.filter((key) => key in goal && !goal[`${key}_default`]).map((key) => `${key}: ${goal[key]}`);

function jerkOf({ duration, jerk_start: start }) {
  if (!duration) return [];
  const times = [`duration: ${duration}`, ...(start === undefined ? [] : [`start: ${start}`])];
  return [`minimum_jerk: {${times.join(', ')}}`];
}

function placeOf(goal) {
  return [
    `link: '${goal.link.replaceAll("'", "''")}'`,
    `point: ${list(goal.point)}`,
    `target: ${list(goal.target)}`,
    ...(goal.quaternion ? [`quaternion: ${list(goal.quaternion)}`] : []),
    ...numbers(goal, 'rotation_weight', 'metric'),
    ...jerkOf(goal),
  ];
}

/** As an item of the file; null for kinds of which the page does not know what they are about. */
function itemOf(goal) {
  const kind = goal.target ? 'reach' : goal.name.replace(/ \(\d+\)$/, '');
  if (!['reach', 'posture', 'damping'].includes(kind)) return null;
  const keys = [
    ...(goal.target ? placeOf(goal) : []),
    ...numbers(goal, 'weight', 'stiffness', 'damping', 'rate', 'start', 'end'),
  ];
  return `- ${kind}: {${keys.join(', ')}}`;
}

/** Why a goal does not act at the time of the status; empty where it does. */
export function whyNot(goal, time) {
  if (goal.acts) return '';
  if (!goal.on) return 'switched off';
  return goal.end <= time ? `ended at ${goal.end} s` : `from ${goal.start} s`;
}

export function goalsText(status, run) {
  const lines = [
    `# Goals of a live run that were in force at ${status.time} s.`,
    `# simulate_gdd ${run.header.model} --goals goals.yaml`,
  ];
  const items = [];
  for (const goal of status.goals) {
    const item = itemOf(goal);
    const why = whyNot(goal, status.time);
    if (item && !why) items.push(`  ${item}`);
    else lines.push(`# ${why || 'not kept'}: ${item ?? goal.name}`.replaceAll('\n', ' '));
  }
  return `${[...lines, items.length > 0 ? 'goals:' : 'goals: []', ...items].join('\n')}\n`;
}
