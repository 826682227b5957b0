// The floor in one line.

/** "12 work, 3 walk, 2 idle; 14 jobs wait": people by state, the most frequent first; jobs in all queues. */
export function summaryOf(world) {
  const { variant } = world,
    counts = new Map();
  for (let worker = 0; worker < world.nWorkers; worker++) {
    const state = variant.states[world.doing(worker).state];
    counts.set(state, (counts.get(state) || 0) + 1);
  }
  const people = [...counts]
    .sort((a, b) => b[1] - a[1])
    .map(([state, count]) => `${count} ${state.words || state.name}`);
  const queued = variant.stations.reduce((sum, _, i) => sum + world.station(i).queue, 0);
  const who = people.length ? `${people.join(", ")}; ` : "";
  return `${who}${queued} ${queued === 1 ? "job waits" : "jobs wait"}`;
}
