// SPDX-License-Identifier: Apache-2.0
// The goals in force as a file that simulate_gdd --goals reads.

const list = (vector) => `[${vector.join(', ')}]`;

function keysOf(goal) {
  const numbers = ['weight', 'stiffness', 'damping', 'rate']
    .filter((key) => key in goal)
    .map((key) => `${key}: ${goal[key]}`);
  return goal.target
    ? [
        `link: '${goal.link.replaceAll("'", "''")}'`,
        `point: ${list(goal.point)}`,
        `target: ${list(goal.target)}`,
        ...numbers,
        ...(goal.duration ? [`minimum_jerk: {duration: ${goal.duration}}`] : []),
      ]
    : numbers;
}

/** Goals of other kinds are named in a comment: the page does not know what they are about. */
export function goalsText(status, run) {
  const lines = ['# Goals of a live run.', `# simulate_gdd ${run.header.model} --goals goals.yaml`];
  const items = [];
  for (const goal of status.goals.filter(({ on }) => on)) {
    const kind = goal.target ? 'reach' : goal.name.replace(/ \(\d+\)$/, '');
    if (kind === 'reach' || kind === 'posture' || kind === 'damping')
      items.push(`  - ${kind}: {${keysOf(goal).join(', ')}}`);
    else lines.push(`# not here: ${goal.name}`);
  }
  return `${[...lines, items.length > 0 ? 'goals:' : 'goals: []', ...items].join('\n')}\n`;
}
