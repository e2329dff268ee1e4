'use strict';

document.addEventListener('DOMContentLoaded', () => {
  const data = JSON.parse(document.getElementById('counterflex-data').textContent);
  const heading = document.createElement('h1');
  heading.textContent = `${data.runs[0].report.summary.before?.max_mm} mm before`;
  document.getElementById('page').append(heading);
  document.documentElement.dataset.ready = 'yes';
});
