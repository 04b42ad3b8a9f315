// SPDX-License-Identifier: Apache-2.0
// The curves as a table that spreadsheets read: a row a sample, a column a curve.

const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

export function curvesText(run) {
  const time = run.array('series_time');
  const curves = run.header.series.groups.flatMap(({ name, unit, curves: list }) =>
    list.map((curve) => ({
      title: `${name}: ${curve.name}${unit ? ` [${unit}]` : ''}`,
      values: run.array(curve.values),
    })),
  );
  const lines = [['time_s', ...curves.map(({ title }) => title)].map(quoted).join(',')];
  for (let i = 0; i < time.length; ++i)
    lines.push(
      [time[i], ...curves.map(({ values }) => (Number.isNaN(values[i]) ? '' : values[i]))].join(','),
    );
  return `${lines.join('\n')}\n`;
}
