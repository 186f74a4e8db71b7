// SPDX-License-Identifier: AGPL-3.0-or-later
// What the page knows of the farm. The server's pieces are states, not steps: the latest one is right.

export class Model {
	jobs = new Map();
	workers = new Map();
	/** The job that is shown, or null. */
	chosen = null;
	/** Its strips, a letter each: w waits, r waits again, o out, a out again, s settled, x given up; and per frame how many are settled. */
	strips = "";
	settled = [];
	/** Goes up when any of them changes. */
	version = 0;
	/** Goes up when something failed in the chosen job. */
	failures = 0;
	/** Seconds that the server's clock is ahead of ours. */
	ahead = 0;
	heard = false;

	/** `changed` is called after each piece; `refused` with a line for people. */
	constructor(changed, refused) {
		this.changed = changed;
		this.refused = refused;
	}

	now() { return Date.now() / 1000 + this.ahead; }

	take(piece) {
		if (piece.time)
			this.ahead = piece.time - Date.now() / 1000;
		if (piece.event === "all" || piece.event === "jobs")
			this.jobs.clear();
		if (piece.event === "all")
			this.workers.clear();
		for (const job of piece.jobs ?? [])
			this.jobs.set(job.id, job);
		for (const worker of piece.workers ?? [])
			this.workers.set(worker.id, { ...worker, seen: Date.now() / 1000 });
		for (const id of piece.removed ?? [])
			this.jobs.delete(id);
		for (const id of piece.gone ?? [])
			this.workers.delete(id);
		this.heard = true;
		this.choose();
		if (piece.event === "all" && this.chosen)
			this.load();
		if (this.chosen) {
			const news = piece.strips?.[this.chosen.id];
			if (news)
				this.loading ? this.loading.push(news) : this.apply(news);
			if (piece.failures?.some(f => f.job === this.chosen.id))
				++this.failures;
		}
		this.changed();
	}

	/** The job in the address; without one, whatever is being rendered, else the newest. */
	choose() {
		const asked = Number(/^#job-(\d+)$/.exec(location.hash)?.[1] ?? 0);
		let best = this.jobs.get(asked) ?? null;
		if (!best)
			for (const job of this.jobs.values()) {
				const worth = j => [j.stage === "running" && j.strips_out > 0, j.stage === "running", j.id === this.chosen?.id, j.id];
				const [a, b] = [worth(job), best ? worth(best) : []];
				const at = a.findIndex((v, i) => v !== b[i]);
				if (!best || a[at] > b[at])
					best = job;
			}
		const other = best?.id !== this.chosen?.id || (best && best.created !== this.chosen.created);
		this.chosen = best;
		if (other) {
			this.strips = [];
			this.settled = [];
			this.failures = 0;
			if (best)
				this.load();
		}
	}

	// Changes that come while we wait are put on top of what we get: whichever of the two is newer, the end is right.
	async load() {
		const job = this.chosen, later = this.loading = [];
		try {
			const answer = await fetch(`/v1/jobs/${job.id}/strips`);
			if (!answer.ok || this.loading !== later)
				return;
			const { strips } = await answer.json();
			if (this.loading !== later)
				return;
			this.strips = [...strips];
			this.settled = new Array(job.frames).fill(0);
			this.strips.forEach((letter, i) => { this.settled[Math.floor(i / job.strips_per_frame)] += letter === "s"; });
			++this.version;
			++this.failures;
		} catch { // the stream will say when the server is back
			return;
		} finally {
			if (this.loading === later)
				this.loading = null;
		}
		later.forEach(news => this.apply(news));
		this.changed();
	}

	apply(news) {
		++this.version;
		for (const [strip, letter] of news) {
			if (strip >= this.strips.length)
				continue;
			this.settled[Math.floor(strip / this.chosen.strips_per_frame)] += (letter === "s") - (this.strips[strip] === "s");
			this.strips[strip] = letter;
		}
	}

	/** The letters of one frame of the chosen job. */
	frame(index) {
		const per = this.chosen.strips_per_frame;
		return this.strips.slice(index * per, (index + 1) * per);
	}
	/** POV-Ray's number of it. */
	number(index) { return this.chosen.first + index * this.chosen.step; }

	/** pause, resume, cancel or retry. */
	async command(what) {
		try {
			const answer = await fetch(`/v1/jobs/${this.chosen.id}/${what}`, { method: "POST" });
			if (answer.status === 401)
				return location.reload();
			this.refused(answer.ok ? "" : (await answer.json()).error);
		} catch {
			this.refused("The server does not answer.");
		}
	}
}
