// What an accessibility checker looks at, as far as it can be computed: the contrast of every text with what is
// behind it, names of controls and pictures, the order of headings, unique ids. Debian packages no such checker.
(() => {
  const numbers = (colour) => colour.match(/[\d.]+/g).map(Number);
  const luminance = (colour) => {
    const [r, g, b] = numbers(colour).slice(0, 3).map((c) => {
      const part = c / 255;
      return part <= 0.04045 ? part / 12.92 : Math.pow((part + 0.055) / 1.055, 2.4);
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const behind = (element) => {
    for (let e = element; e; e = e.parentElement) {
      const colour = getComputedStyle(e).backgroundColor;
      if (numbers(colour)[3] !== 0) return colour;
    }
    return 'rgb(255, 255, 255)';
  };
  const contrasts = [], faults = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement, text = node.textContent.trim();
    if (!text || element.closest('script, style, noscript') || element.getClientRects().length === 0) continue;
    const drawn = element.closest('svg');
    const colour = drawn ? element.getAttribute('fill') && getComputedStyle(element).fill : getComputedStyle(element).color;
    if (!colour) continue;
    const [a, b] = [luminance(colour), luminance(behind(drawn || element))];
    contrasts.push({text: text.slice(0, 40), colour, ratio: (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)});
  }
  const nameOf = (e) => e.getAttribute('aria-label') || e.getAttribute('aria-labelledby') || e.textContent.trim() ||
      (e.labels && [...e.labels].map((l) => l.textContent.trim()).join(' '));
  for (const e of document.querySelectorAll('button, select, input, a, summary, [role=img], [role=region], nav')) {
    if (!nameOf(e)) faults.push(`no name: ${e.outerHTML.slice(0, 80)}`);
  }
  for (const e of document.querySelectorAll('svg, canvas, img')) {
    if (!e.closest('[role=img], [aria-hidden=true]') && !e.getAttribute('alt')) faults.push(`no alternative: ${e.outerHTML.slice(0, 80)}`);
  }
  let level = 0;
  for (const h of document.querySelectorAll('h1, h2, h3, h4, h5, h6')) {
    const here = Number(h.tagName[1]);
    if (here > level + 1) faults.push(`heading skips a level: ${h.textContent}`);
    level = here;
  }
  const ids = [...document.querySelectorAll('[id]')].map((e) => e.id);
  for (const id of new Set(ids)) {
    if (ids.filter((other) => other === id).length > 1) faults.push(`id twice: ${id}`);
  }
  if (document.querySelectorAll('h1').length !== 1) faults.push('not one h1');
  if (!document.documentElement.lang) faults.push('no language');
  if (!document.title) faults.push('no title');
  for (const table of document.querySelectorAll('table')) {
    if (!table.caption || !table.caption.textContent) faults.push('table without caption');
  }
  return {contrasts, faults};
})()
