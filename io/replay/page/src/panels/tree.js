// SPDX-License-Identifier: Apache-2.0
// The tree of links: bodies by the joints that carry them, links fixed to a body below it.
//
// One tab stop; within it up and down move, left and right close and open, enter selects.

import { element, icon } from '../app/dom.js';

/** The roots, each {link, body, name, children}. */
function build(run) {
  const { bodies, links } = run;
  // The link that stands for a body; for the world only one of its name, or its only one.
  const own = bodies.map((body, b) => {
    const on = links.filter((link) => link.body === b);
    return on.find((link) => link.name === body.name) ?? (b > 0 || on.length === 1 ? on[0] : null);
  });
  const nodes = bodies.map((body, b) => ({
    link: own[b] ?? null,
    body,
    name: own[b]?.name ?? body.name,
    children: [],
  }));
  bodies.forEach((body, b) => {
    if (body.parent >= 0) nodes[body.parent].children.push(nodes[b]);
  });
  for (const link of links)
    if (link !== own[link.body])
      nodes[link.body].children.push({ link, body: null, name: link.name, children: [] });
  return nodes[0].link ? [nodes[0]] : nodes[0].children;
}

export class Tree {
  constructor(host, run, selection) {
    this.selection = selection;
    this.rows = [];
    this.search = element('input', {
      type: 'search',
      id: 'search',
      placeholder: 'Search links and joints',
      'aria-label': 'Search links and joints',
      autocomplete: 'off',
      spellcheck: 'false',
      title: 'Search (/)',
      oninput: () => this.#filter(),
    });
    this.list = element('ul', {
      role: 'tree',
      'aria-label': 'Links',
      class: 'tree',
      onkeydown: (event) => this.#key(event),
    });
    this.none = element(
      'p',
      { class: 'quiet none', hidden: true },
      'No link or joint has this in its name.',
    );
    for (const node of build(run)) this.#add(node, null, 1, this.list);
    host.append(this.search, element('div', { class: 'scroll' }, this.list, this.none));
    this.search.addEventListener('keydown', (event) => {
      if (event.key === 'Enter')
        selection.select(this.rows.find((row) => row.matches)?.name ?? null);
      if (event.key === 'ArrowDown') {
        this.#visible()[0]?.item.focus();
        event.preventDefault();
      }
      if (event.key === 'Escape') {
        this.search.value = '';
        this.#filter();
        this.search.blur();
      }
    });
    if (this.rows.length > 0) this.rows[0].item.tabIndex = 0;
    selection.on('change', () => this.#showSelection());
  }

  #add(node, parent, level, list) {
    const joint = node.body?.joint && node.body.kind !== 'floating' ? node.body.joint : '';
    // In a scene both names begin with the robot's; once is enough.
    const robot = node.name.slice(0, node.name.lastIndexOf('/') + 1);
    const short = joint.startsWith(robot) ? joint.slice(robot.length) : joint;
    const twist = element('span', { class: 'twist' }, icon('chevron'));
    const label = element(
      'span',
      { class: 'row' },
      twist,
      element('span', { class: 'name', title: node.name }, node.name),
      joint && joint !== node.name ? element('span', { class: 'joint', title: joint }, short) : null,
    );
    const item = element(
      'li',
      {
        role: 'treeitem',
        'aria-level': level,
        tabindex: '-1',
        'aria-label': joint ? `${node.name}, joint ${joint}` : node.name,
      },
      label,
    );
    const row = {
      item,
      parent,
      name: node.name,
      text: `${node.name} ${joint}`.toLowerCase(),
      children: [],
      matches: true,
    };
    label.addEventListener('click', (event) => {
      if (twist.contains(event.target) && row.children.length > 0)
        this.#open(row, !this.#isOpen(row));
      else this.selection.select(node.link ? node.name : null);
      this.#mark(row);
    });
    this.rows.push(row);
    list.append(item);
    if (node.children.length > 0) {
      const inner = element('ul', { role: 'group' });
      item.append(inner);
      item.setAttribute('aria-expanded', 'true');
      row.children = node.children.map((child) => this.#add(child, row, level + 1, inner));
    } else {
      twist.classList.add('leaf');
    }
    return row;
  }

  #isOpen(row) {
    return row.item.getAttribute('aria-expanded') === 'true';
  }

  #open(row, open) {
    row.item.setAttribute('aria-expanded', open);
  }

  /** The row that the tab key comes to. A click leaves the keyboard where it is. */
  #mark(row) {
    for (const other of this.rows) other.item.tabIndex = other === row ? 0 : -1;
  }

  #focus(row) {
    this.#mark(row);
    row.item.focus({ preventScroll: true });
    row.item.firstChild.scrollIntoView({ block: 'nearest' });
  }

  /** Rows that are seen, from top to bottom. */
  #visible() {
    return this.rows.filter((row) => {
      if (row.item.hidden) return false;
      for (let p = row.parent; p; p = p.parent) if (!this.#isOpen(p)) return false;
      return true;
    });
  }

  #key(event) {
    const rows = this.#visible();
    const at = rows.findIndex((row) => row.item === document.activeElement);
    const row = rows[at];
    if (!row) return;
    const go = { ArrowDown: rows[at + 1], ArrowUp: rows[at - 1], Home: rows[0], End: rows.at(-1) }[
      event.key
    ];
    if (go) this.#focus(go);
    else if (event.key === 'ArrowRight' && row.children.length > 0)
      this.#isOpen(row) ? this.#focus(row.children[0]) : this.#open(row, true);
    else if (event.key === 'ArrowLeft')
      row.children.length > 0 && this.#isOpen(row)
        ? this.#open(row, false)
        : row.parent && this.#focus(row.parent);
    else if (event.key === 'Enter' || event.key === ' ') this.selection.select(row.name);
    else if (!['ArrowDown', 'ArrowUp', 'Home', 'End', 'ArrowRight'].includes(event.key)) return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Rows whose name has the words, and what leads to them. */
  #filter() {
    const words = this.search.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const visit = (row) => {
      row.matches = words.every((word) => row.text.includes(word));
      const below = row.children.map(visit).some(Boolean);
      row.item.hidden = !(row.matches || below);
      row.item.classList.toggle('dim', words.length > 0 && !row.matches);
      if (below && words.length > 0) this.#open(row, true);
      return !row.item.hidden;
    };
    const any = this.rows
      .filter((row) => row.parent === null)
      .map(visit)
      .some(Boolean);
    this.none.hidden = any;
  }

  #showSelection() {
    for (const row of this.rows) {
      const chosen = row.name === this.selection.name;
      if (chosen) this.#mark(row);
      row.item.setAttribute('aria-selected', chosen);
      if (!chosen) continue;
      for (let p = row.parent; p; p = p.parent) this.#open(p, true);
      // The numbers that open below take room from the tree first.
      requestAnimationFrame(() => row.item.firstChild.scrollIntoView({ block: 'nearest' }));
    }
  }
}
