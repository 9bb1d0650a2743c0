package voqcal.spy;

import java.awt.Color;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;
import java.awt.image.BufferedImage;
import java.io.ByteArrayInputStream;
import java.io.IOException;
import javax.imageio.ImageIO;
import lcm.lcm.LCMDataInputStream;
import voqcal.camera_board_t;
import voqcal.image_t;

/** The newest image of a channel, with the inner corners that the camera board detector found in it. */
class ImageView extends View {
  private static final int GRAY = 1497715271;
  private static final int RGB = 859981650;
  private static final int BGR = 861030210;
  private static final int MJPEG = 1196444237;
  private static final int PNG = 541544016;
  private static final int CORNER_RADIUS = 4;

  private BufferedImage image;
  private long imageUtime;
  private camera_board_t board;

  ImageView(String channel) {
    super(channel, camera_board_t.LCM_FINGERPRINT);
  }

  @Override
  void takeSensorMessage(LCMDataInputStream message) throws IOException {
    image_t newest = new image_t(message);
    BufferedImage decoded = decode(newest);
    synchronized (this) {
      image = decoded;
      imageUtime = newest.utime;
    }
  }

  @Override
  void takeBoardMessage(LCMDataInputStream message) throws IOException {
    camera_board_t newest = new camera_board_t(message);
    synchronized (this) {
      board = newest;
    }
  }

  @Override
  protected synchronized void paintComponent(Graphics graphics) {
    super.paintComponent(graphics);
    if (image == null) {
      return;
    }
    double scale =
        Math.min((double) getWidth() / image.getWidth(), (double) getHeight() / image.getHeight());
    Graphics2D canvas = (Graphics2D) graphics.create();
    canvas.drawImage(
        image, 0, 0, (int) (scale * image.getWidth()), (int) (scale * image.getHeight()), null);
    if (board != null && board.utime == imageUtime) {
      drawBoard(canvas, scale);
    }
    canvas.dispose();
  }

  private void drawBoard(Graphics2D canvas, double scale) {
    canvas.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    canvas.setColor(Color.GREEN);
    if (!board.miss.isEmpty()) {
      canvas.drawString("no board: " + board.miss, 8, 18);
      return;
    }
    double lastX = 0;
    double lastY = 0;
    for (int i = 0; i < board.num_corners; ++i) {
      // Pixel (0, 0) is the centre of the top-left pixel, a half from the canvas's corner.
      double x = scale * (board.corners_px[i][0] + 0.5);
      double y = scale * (board.corners_px[i][1] + 0.5);
      canvas.setColor(Color.getHSBColor(0.8f * i / board.num_corners, 1, 1));
      canvas.draw(
          new Ellipse2D.Double(
              x - CORNER_RADIUS, y - CORNER_RADIUS, 2 * CORNER_RADIUS, 2 * CORNER_RADIUS));
      if (i > 0) {
        canvas.draw(new Line2D.Double(lastX, lastY, x, y));
      }
      lastX = x;
      lastY = y;
    }
  }

  private static BufferedImage decode(image_t message) throws IOException {
    switch (message.pixelformat) {
      case MJPEG:
      case PNG:
        BufferedImage decoded = ImageIO.read(new ByteArrayInputStream(message.data));
        if (decoded == null) {
          throw new IOException("an image that ImageIO does not know");
        }
        return decoded;
      case GRAY:
        return fromRows(message, 0, 0, 0, 1);
      case RGB:
        return fromRows(message, 0, 1, 2, 3);
      case BGR:
        return fromRows(message, 2, 1, 0, 3);
      default:
        throw new IOException("pixel format " + message.pixelformat);
    }
  }

  /** Red, green and blue are at these bytes of a pixel, which takes `step` bytes. */
  private static BufferedImage fromRows(image_t message, int red, int green, int blue, int step) {
    BufferedImage image =
        new BufferedImage(message.width, message.height, BufferedImage.TYPE_INT_RGB);
    for (int y = 0; y < message.height; ++y) {
      for (int x = 0; x < message.width; ++x) {
        int at = y * message.row_stride + x * step;
        image.setRGB(
            x,
            y,
            (message.data[at + red] & 0xff) << 16
                | (message.data[at + green] & 0xff) << 8
                | message.data[at + blue] & 0xff);
      }
    }
    return image;
  }
}
