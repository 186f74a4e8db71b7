// SPDX-License-Identifier: AGPL-3.0-or-later
// The chosen job: how far it is, and what can be done with it.
import { byId, count, duration, el, keyed, moment, plural, rate, say } from "./text.js";

/** Strips a minute, by what its strips took so far and how many are out. */
export function jobRate(job) {
	return job.stage === "running" && job.strip_seconds ? 60 * job.strips_out / job.strip_seconds : 0;
}

function figures(job, model) {
	const over = job.ended > 0;
	const list = [
		["frames", `${count(job.frames_done)} of ${count(job.frames)}`],
		["strips", `${count(job.strips_done)} of ${count(job.strips)}`],
	];
	if (!over) {
		list.push(["out now", count(job.strips_out)]);
		list.push(["strips a minute", jobRate(job) ? rate(jobRate(job)) : "–"]);
		list.push(["to go", job.eta !== null && job.stage === "running" ? duration(job.eta) : "–"]);
	}
	list.push([over ? "took" : "for", duration((over ? job.ended : model.now()) - job.created)]);
	list.push(["since", moment(job.created)]);
	list.push(["pixels", `${job.width} × ${job.height}`]);
	return list;
}

function notes(job) {
	const list = [];
	if (job.doing)
		list.push(job.doing[0].toUpperCase() + job.doing.slice(1) + ".");
	if (job.whole_because)
		list.push(`Frames are rendered whole: ${job.whole_because}.`);
	if (job.priority)
		list.push(`Priority ${job.priority}.`);
	if (job.stage === "done")
		list.push(`bhfarm fetch ${job.id} brings ${job.frames === 1 ? "the picture" : `all ${plural(job.frames, "picture")}`}${job.film ? " and the film" : ""}.`);
	return list.join(" ");
}

export function drawJob(model) {
	const job = model.chosen;
	byId("job").hidden = !job;
	byId("nothing").hidden = Boolean(job) || !model.heard;
	if (!job) {
		const where = location.origin;
		say(byId("submit-line"), `bhfarm submit --server ${where} scenes/fall.ini`);
		say(byId("worker-line"), `bhfarm-worker --server ${where}`);
		return;
	}
	say(byId("job-title"), job.name);
	say(byId("stage"), job.stage);
	byId("stage").dataset.stage = job.stage;
	byId("job-error").hidden = !job.error;
	say(byId("job-error"), job.error);
	const bar = byId("bar");
	bar.setAttribute("aria-valuemax", job.strips);
	bar.setAttribute("aria-valuenow", job.strips_done);
	bar.children[0].style.width = `${100 * job.strips_done / job.strips}%`;
	bar.children[1].style.width = `${100 * Math.min(job.strips_out, job.strips - job.strips_done) / job.strips}%`;
	keyed(byId("job-figures"), figures(job, model), f => f[0], f => el("div", {}, el("dt", {}, f[0]), el("dd")), (e, f) => say(e.lastChild, f[1]));
	say(byId("job-note"), notes(job));
	byId("job-note").hidden = !notes(job);
	const may = { pause: job.stage === "running", resume: job.stage === "paused", retry: job.stage === "failed", cancel: ["running", "paused", "failed"].includes(job.stage) };
	for (const [what, allowed] of Object.entries(may))
		byId(what).hidden = !allowed;
	const film = byId("film");
	film.hidden = !(job.stage === "done" && job.film && !job.error);
	film.href = `/v1/jobs/${job.id}/film`;
	film.download = job.film;
}

/** The buttons; each asks the server, and what comes of it is seen by the stream. */
export function wireJob(model) {
	for (const what of ["pause", "resume", "retry"])
		byId(what).onclick = () => model.command(what);
	const sure = byId("sure");
	byId("cancel").onclick = () => {
		say(byId("sure-title"), `Cancel ${model.chosen.name}?`);
		sure.returnValue = "";
		sure.dataset.job = model.chosen.id;
		sure.showModal();
	};
	sure.onclose = () => {
		if (sure.returnValue === "yes" && String(model.chosen?.id) === sure.dataset.job)
			model.command("cancel");
	};
}
