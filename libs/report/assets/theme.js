// Light and dark: the reader's choice, or what the system prefers; paper is always light.

const theme = (() => {
  const root = document.documentElement;
  const system = window.matchMedia('(prefers-color-scheme: dark)');
  const darkOf = JSON.parse(document.getElementById('dark-colours').textContent);
  const listeners = [];
  let choice = 'auto';
  let printing = false;

  function apply() {
    const dark = !printing && (choice === 'dark' || (choice === 'auto' && system.matches));
    const name = dark ? 'dark' : 'light';
    if (root.dataset.theme !== name) {
      root.dataset.theme = name;
      listeners.forEach((listener) => listener());
    }
  }

  /** A copy of a specification, or a single colour, with the colours of the theme in place of those for paper. */
  function themed(value) {
    if (root.dataset.theme !== 'dark') return value;
    if (typeof value === 'string') return darkOf[value] || value;
    if (Array.isArray(value)) return value.map(themed);
    if (value === null || typeof value !== 'object') return value;
    return Object.fromEntries(Object.entries(value).map(
        ([key, part]) => [key, key === 'data' ? part : themed(part)]));
  }

  system.addEventListener('change', apply);
  apply();
  return {
    themed,
    colour: (name) => getComputedStyle(root).getPropertyValue(`--${name}`).trim(),
    onChange: (listener) => listeners.push(listener),
    choose: (name) => { choice = name; apply(); },
    isForPaper: () => printing,
    forPaper: (on) => { printing = on; apply(); },
  };
})();
