// SPDX-License-Identifier: Apache-2.0
// Runs inside the page: which buttons have no name, are outside the window or over another.

export function misplacedButtons() {
  const shown = [
    ...document.querySelectorAll(
      '#top button, #toolbar button, #toolbar select, #transport button, #transport select, .panel-head button',
    ),
  ].filter((node) => node.checkVisibility());
  const boxes = shown.map((node) => node.getBoundingClientRect());
  const name = (node) => node.getAttribute('aria-label') ?? node.textContent.trim();
  const bad = shown.filter((node) => !name(node)).map((node) => node.outerHTML);
  boxes.forEach((a, i) => {
    if (a.left < 0 || a.top < 0 || a.right > innerWidth || a.bottom > innerHeight)
      bad.push(`${name(shown[i])} is outside`);
    boxes.slice(i + 1).forEach((b, k) => {
      if (
        a.left < b.right - 1 &&
        b.left < a.right - 1 &&
        a.top < b.bottom - 1 &&
        b.top < a.bottom - 1
      )
        bad.push(`${name(shown[i])} and ${name(shown[i + 1 + k])} overlap`);
    });
  });
  return bad;
}
