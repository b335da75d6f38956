// SPDX-License-Identifier: GPL-3.0-or-later
// How a job fares, as it happens. When it is over, the page is loaded again.
import {counted, element, pagePath} from '../page.js';

const kOver = ['successful', 'failed', 'dismissed'];

/// A time in words.
function inWords(seconds) {
  if (seconds < 90) return counted(Math.round(seconds), 'second');
  return counted(Math.round(seconds / 60), 'minute');
}

function sentenceOf(job) {
  let text = `${job.status}: ${job.message}.`;
  if (job.status !== 'running') return text;
  text += ` ${counted(job.featuresJudged ?? 0, 'feature')} judged`;
  if (job.featuresPerSecond) text += `, ${counted(job.featuresPerSecond, 'feature')} a second`;
  if (job.secondsLeft !== undefined) text += `, about ${inWords(job.secondsLeft)} left`;
  return `${text}.`;
}

export function showJob(container) {
  const progress = element('progress', {max: 100, 'aria-label': 'Progress'});
  const said = element('p', {role: 'status'});
  container.replaceChildren(progress, said);
  const events = new EventSource(`${pagePath()}/events`);
  events.addEventListener('status', (event) => {
    const job = JSON.parse(event.data);
    progress.value = job.progress;
    said.textContent = sentenceOf(job);
    if (!kOver.includes(job.status)) return;
    events.close();
    location.reload();
  });
  events.onerror = () => {
    said.textContent = 'The service does not answer; the job goes on when it runs again.';
  };
}
