// SPDX-License-Identifier: Apache-2.0
// This page as text, to be written with another run in it.

const RUN = '@RUN@';

/**
 * The page as it came, without its run; to be called before anything is added to it. What follows
 * "connect-src" in its policy is left out: a page in a file may ask nothing of any network.
 */
export function ownText(runElement) {
  runElement.textContent = RUN;
  const comments = [...document.childNodes].filter(({ nodeType }) => nodeType === Node.COMMENT_NODE);
  const head = comments.map(({ data }) => `<!--${data}-->\n`).join('');
  const text = `<!doctype html>\n${head}${document.documentElement.outerHTML}\n`;
  runElement.textContent = '';
  return text.replace("; connect-src 'self'", '');
}

/** That text with a run, as base64. */
export const withRun = (text, run) => text.replace(`>${RUN}<`, () => `>${run}<`);
