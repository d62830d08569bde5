// Starts what the page holds: figures when they come near the window, the rest while nothing else is to do.

(() => {
  const plots = new Map();
  const shown = (element) => {
    if (plots.has(element)) return;
    const plot = new Plot(element);
    plots.set(element, plot);
    plot.show();
    plot.keepForPaper();
    new PlotTools(plot, element.dataset.figure);
  };
  const figures = [...document.querySelectorAll('figure[data-figure]')];
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (entry.isIntersecting) shown(entry.target);
    }
  }, {rootMargin: '600px'});
  figures.forEach((figure) => observer.observe(figure));

  const idle = window.requestIdleCallback || ((action) => setTimeout(action, 50));
  const rest = [...figures];
  const showNext = () => {
    if (rest.length === 0) {
      document.documentElement.dataset.ready = 'true';
      return;
    }
    shown(rest.shift());
    idle(showNext);
  };
  idle(showNext);

  const replays = [...document.querySelectorAll('[data-replay]')].map((element) => new Replay(element));

  theme.onChange(() => {
    plots.forEach((plot) => {
      if (theme.isForPaper() && plot.paper) plot.canvas.innerHTML = plot.paper;
      else plot.show();
    });
    replays.forEach((replay) => replay.draw());
  });
  document.getElementById('theme').addEventListener('change', (event) => theme.choose(event.target.value));
  document.getElementById('print').addEventListener('click', () => window.print());
  // A4 less its margins, in CSS pixels; tables are printed in 8 pt, 0.74 of their size on the screen.
  const paperWidth = 680, printedPart = 0.74;
  const fitTablesToPaper = (fit) => {
    for (const table of document.querySelectorAll('table')) {
      const width = printedPart * table.scrollWidth;
      table.style.zoom = fit && width > paperWidth ? paperWidth / width : '';
    }
  };
  window.addEventListener('beforeprint', () => {
    figures.forEach(shown);
    fitTablesToPaper(true);
    document.querySelectorAll('main section > details').forEach((details) => { details.open = true; });
    theme.forPaper(true);
  });
  window.addEventListener('afterprint', () => {
    fitTablesToPaper(false);
    theme.forPaper(false);
  });

  for (const copy of document.querySelectorAll('button[data-copies]')) {
    copy.addEventListener('click', () => {
      const text = document.getElementById(copy.dataset.copies).textContent;
      navigator.clipboard.writeText(text).then(() => { copy.textContent = 'Copied'; });
    });
  }
})();
