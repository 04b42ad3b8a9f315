// SPDX-License-Identifier: Apache-2.0
// Pictures of a replay page's view, at instants.

/// The page NAME of the browser's folder, and picture(t): its view at t [s] as PNG.
export async function still(browser, name, settings = {}, width = 520) {
  const page = await browser.open(name, { width, height: 460, scheme: 'light' });
  await page.evaluate(
    (more) => window.softgauss.setView({ links: false, plots: false, preset: 'home', ...more }),
    settings,
  );
  const clip = await page.evaluate(() => {
    document.querySelector('#toolbar').style.display = 'none';
    const { x, y, width, height } = document.querySelector('canvas').getBoundingClientRect();
    return { x, y, width, height };
  });
  const picture = async (time) => {
    await page.evaluate((t) => window.softgauss.seek(t), time);
    await page.waitForTimeout(300);
    return page.screenshot({ clip, timeout: 600000 });
  };
  await picture(0);
  await page.waitForTimeout(1000);
  return { page, picture };
}
