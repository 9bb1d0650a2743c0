// Whether two sensors' stamps are of one clock, told by when their messages were recorded.

const S = 1_000_000_000;
// A stamp is set before its message is recorded: by up to so much (a sweep's first point, a long exposure, a slow
// network), and hardly ever after it.
const MAX_BEFORE_S = 0.6;
const MAX_AFTER_S = 0.02;
// So far apart are delays of two sensors on one clock.
const MAX_DELAYS_APART_S = 0.25;

/**
 * @param lidar, camera  {logTimeNs, stampNs} of their first messages, BigInt, by log time.
 * @returns {useLogTimes, words}: words is undefined where there is nothing to say. Where log times do not help, whether stamps
 *     are used is for all sensors to tell.
 */
export function judgeClocks(lidar, camera) {
  const problem = stampProblem("clouds", lidar) ?? stampProblem("images", camera) ?? difference(lidar, camera);
  if (problem === undefined) return { useLogTimes: false };
  const apartS = logTimesApartS(lidar, camera);
  if (!(apartS < 0.1)) {
    const apart = `nor do the times at which they were recorded agree (${inWords(apartS)} apart)`;
    return { useLogTimes: false, words: `${problem}; ${apart}` };
  }
  return {
    useLogTimes: true,
    words:
      `${problem}; log times agree within ${inWords(apartS)}: using them (--times stamps forbids that). ` +
      "They hold for boards that are held still",
  };
}

/** Stamps that stand still, run backwards or at another speed than the recording. */
function stampProblem(what, messages) {
  if (messages.length === 0) return undefined;
  const [first, last] = [messages[0], messages.at(-1)];
  if (messages.every(({ stampNs }) => stampNs <= 0n)) return `the ${what} have no stamps (0)`;
  const logS = Number(last.logTimeNs - first.logTimeNs) / S;
  const stampS = Number(last.stampNs - first.stampNs) / S;
  if (messages.length < 3 || !(logS > 0)) return undefined;
  if (messages.every(({ stampNs }) => stampNs === first.stampNs)) return `the stamps of the ${what} stand still`;
  if (stampS < 0) return `the stamps of the ${what} run backwards`;
  return undefined;
}

function difference(lidar, camera) {
  if (lidar.length === 0 || camera.length === 0) return undefined;
  const [lidarS, cameraS] = [lidar, camera].map((messages) =>
    median(messages.map(({ stampNs, logTimeNs }) => Number(stampNs - logTimeNs) / S)),
  );
  const isPlausible = (delayS) => delayS > -MAX_BEFORE_S && delayS < MAX_AFTER_S;
  const apartS = Math.abs(lidarS - cameraS);
  const isOneClock =
    isPlausible(lidarS) === isPlausible(cameraS) && (isPlausible(lidarS) || apartS < MAX_DELAYS_APART_S);
  return isOneClock ? undefined : `the clocks of lidar and camera differ by ${inWords(apartS)}`;
}

/** How far from the nearest image a cloud was recorded, at the median. */
function logTimesApartS(lidar, camera) {
  if (lidar.length === 0 || camera.length === 0) return NaN;
  const spansTime = lidar.length < 2 || lidar[0].logTimeNs !== lidar.at(-1).logTimeNs;
  if (!spansTime) return NaN;
  const nearest = ({ logTimeNs }) =>
    Math.min(...camera.map((image) => Math.abs(Number(image.logTimeNs - logTimeNs)))) / S;
  return median(lidar.map(nearest));
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

function inWords(seconds) {
  const year = 365.25 * 86400;
  const units = [[year, "years"], [86400, "days"], [3600, "h"], [60, "min"], [1, "s"]];
  const unit = units.find(([size]) => seconds >= size);
  if (Number.isNaN(seconds)) return "they stand still, not";
  return unit ? `${+(seconds / unit[0]).toPrecision(3)} ${unit[1]}` : `${Math.round(1000 * seconds)} ms`;
}
