// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// The tabs of the campaigns: arrows, Home and End move between them, as the ARIA practices have it.
const tabs = [...document.querySelectorAll('[role=tab]')];
const chosenTab = () => tabs.find(tab => tab.getAttribute('aria-selected') === 'true');

function chooseTab(chosen, changed) {
  for (const tab of tabs) {
    const isChosen = tab === chosen;
    tab.setAttribute('aria-selected', isChosen);
    tab.tabIndex = isChosen ? 0 : -1;
    document.getElementById(tab.getAttribute('aria-controls')).classList.toggle('unchosen', !isChosen);
  }
  changed();
}

function neighbour(key) {
  const i = tabs.indexOf(chosenTab());
  const target = {ArrowRight: i + 1, ArrowDown: i + 1, ArrowLeft: i - 1, ArrowUp: i - 1, Home: 0, End: tabs.length - 1}[key];
  return target === undefined ? null : tabs[(target + tabs.length) % tabs.length];
}

function listenToTabs(changed) {
  document.getElementById('tabs').hidden = tabs.length < 2;
  for (const tab of tabs) {
    tab.addEventListener('click', () => chooseTab(tab, changed));
    tab.addEventListener('keydown', event => {
      const next = neighbour(event.key);
      if (!next) return;
      event.preventDefault();
      chooseTab(next, changed);
      next.focus();
    });
  }
}
