// SPDX-License-Identifier: AGPL-3.0-or-later
// The page: stream -> model -> what is drawn, at most once a screen's frame.
import { byId, count, rate, say } from "./text.js";
import { drawFailures } from "./failures.js";
import { Frame } from "./frame.js";
import { Frames } from "./frames.js";
import { drawJob, jobRate, wireJob } from "./job.js";
import { drawJobs } from "./jobs.js";
import { Model } from "./model.js";
import { Previews } from "./previews.js";
import { Stream } from "./stream.js";
import { drawOverview, watchColours } from "./strips.js";
import { drawWorkers } from "./workers.js";

let asked = false;
function draw() {
	if (asked)
		return;
	asked = true;
	// A tab in the background gets no frames, but its title shall be right.
	document.hidden ? setTimeout(drawNow, 0) : requestAnimationFrame(drawNow);
}

const model = new Model(draw, line => {
	byId("refusal").hidden = !line;
	say(byId("refusal"), line);
});
const previews = new Previews();
const frame = new Frame(model, previews);
const frames = new Frames(model, previews, index => frame.show(index));

function drawTitle(job) {
	const part = job ? Math.floor(100 * job.strips_done / job.strips) : 0;
	const title = job ? `${job.stage === "running" ? `${part} %` : job.stage} · ${job.name} – bhfarm` : "bhfarm";
	if (document.title !== title)
		document.title = title;
}

let drawn = "";
let last = "";
/** For those who do not see it: the chosen job's changes of stage, and nothing more. */
function tell(job) {
	const now = job ? `${job.name} is ${job.stage}` : "";
	if (now !== last)
		say(byId("told"), now);
	last = now;
}

function drawFarm() {
	const workers = [...model.workers.values()];
	const slots = workers.reduce((n, w) => n + w.slots, 0), busy = workers.reduce((n, w) => n + (w.busy ?? 0), 0);
	const all = [...model.jobs.values()].reduce((n, j) => n + jobRate(j), 0);
	say(byId("worker-count"), count(workers.length));
	say(byId("slots-busy"), `${count(busy)} of ${count(slots)}`);
	say(byId("farm-rate"), all ? rate(all) : "–");
}

function drawNow() {
	asked = false;
	const job = model.chosen;
	drawTitle(job);
	if (document.hidden)
		return;
	drawFarm();
	drawJobs(model);
	drawJob(model);
	drawWorkers(model);
	const film = byId("overview-box");
	film.hidden = !job || job.frames < 2;
	if (job && model.strips.length) {
		const version = `${job.id} ${model.version}`;
		if (!film.hidden && version !== drawn)
			drawOverview(byId("overview"), model);
		drawn = version;
		frames.draw();
		frame.draw();
	}
	drawFailures(model);
	tell(job);
}

byId("overview").onclick = e => frames.go(Math.floor(e.offsetX / e.currentTarget.clientWidth * model.chosen.frames));
wireJob(model);
watchColours(() => {
	drawn = "";
	draw();
});
addEventListener("hashchange", () => {
	model.choose();
	frames.follow(true);
	draw();
});
document.addEventListener("visibilitychange", draw);
setInterval(draw, 1000); // ages

byId("sign-out").onclick = async () => {
	await fetch("/sign-out", { method: "POST", redirect: "manual" });
	location.reload();
};

new Stream(piece => model.take(piece), state => {
	byId("link").dataset.state = state;
	say(byId("link-text"), state === "live" ? "live" : "the server does not answer; trying on");
});
