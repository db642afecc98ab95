// The panels at the side, one of which is open: tabs after the pattern of WAI-ARIA, arrow keys go from tab to tab.

const tabs = [...document.querySelectorAll("[role=tab]")];
const panel = (tab) => document.getElementById(tab.dataset.tab);

export const names = tabs.map(({ dataset }) => dataset.tab);

// Shows the panel of that name.
export function open(name) {
  for (const tab of tabs) {
    const isOpen = tab.dataset.tab === name;
    tab.setAttribute("aria-selected", isOpen);
    tab.tabIndex = isOpen ? 0 : -1;
    panel(tab).hidden = !isOpen;
  }
}

// `chosen` is called with the name of a panel that was chosen by hand.
export function listen(chosen) {
  for (const [i, tab] of tabs.entries()) {
    tab.id = `tab-${tab.dataset.tab}`;
    tab.setAttribute("aria-controls", tab.dataset.tab);
    panel(tab).setAttribute("aria-labelledby", tab.id);
    tab.addEventListener("click", () => chosen(tab.dataset.tab));
    tab.addEventListener("keydown", (event) => {
      const places = { ArrowRight: i + 1, ArrowLeft: i - 1, Home: 0, End: -1 };
      const other = tabs.at((places[event.key] ?? NaN) % tabs.length);
      if (!(event.key in places) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      other.focus();
      chosen(other.dataset.tab);
    });
  }
}
