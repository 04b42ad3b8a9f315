// SPDX-License-Identifier: Apache-2.0

// All scenarios. Each has
//   name, about      file name of its log, and one sentence
//   scene            see scene.mjs
//   start            {q, v, force} of its trajectories; what is left out is qpos0 or 0
//   states           further states to be evaluated
// and what else record.mjs lists as defaults.

import { trees } from './scenarios/trees.mjs';

export const scenarios = [...trees];
