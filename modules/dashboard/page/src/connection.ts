// The WebSocket to the server, opened again whenever it is lost.

import { decode, type Message, type Request } from "./protocol.ts";

export type ConnectionState = "connecting" | "live" | "lost" | "expired";

const FIRST_RETRY_MS = 300;
const LAST_RETRY_MS = 3000;

export class Connection {
  private socket: WebSocket | null = null;
  private retryMs = FIRST_RETRY_MS;

  constructor(
    private readonly onMessage: (message: Message) => void,
    private readonly onState: (state: ConnectionState) => void,
  ) {}

  open(): void {
    const url = new URL("socket", location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(url);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.retryMs = FIRST_RETRY_MS;
      this.onState("live");
    };
    socket.onmessage = (event) => this.onMessage(decode(event.data));
    socket.onclose = () => void this.openLater();
    this.socket = socket;
  }

  /** False if there is no connection: nothing was sent. */
  send(request: Request): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(request));
    return true;
  }

  private async openLater(): Promise<void> {
    this.onState((await isExpired()) ? "expired" : "lost");
    setTimeout(() => this.open(), this.retryMs);
    this.retryMs = Math.min(2 * this.retryMs, LAST_RETRY_MS);
  }
}

/** Whether a server is there that does not know this page's token. */
async function isExpired(): Promise<boolean> {
  try {
    return (await fetch(location.href, { cache: "no-store" })).status === 403;
  } catch {
    return false;
  }
}
